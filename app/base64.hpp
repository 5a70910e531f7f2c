#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace torsion::engine {

/// RFC 4648.
std::string base64(std::string_view bytes);

/// The bytes of plain rows.
template <class Row>
std::string base64_of(const std::vector<Row>& rows) {
  const auto bytes = std::as_bytes(std::span(rows));
  return base64({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

}  // namespace torsion::engine
