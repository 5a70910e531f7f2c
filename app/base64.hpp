#pragma once

#include <string>
#include <string_view>

namespace torsion::engine {

/// RFC 4648.
std::string base64(std::string_view bytes);

}  // namespace torsion::engine
