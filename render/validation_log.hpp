#pragma once

#include <string>
#include <vector>

namespace torsion::engine {

/// What the validation layers said, one text for each message.
struct ValidationLog {
  std::vector<std::string> messages;
};

}  // namespace torsion::engine
