#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace torsion::engine {

/// The parts of a text that have `between` between them, empty ones too; at least one.
inline std::vector<std::string> split_text(std::string_view text, char between) {
  std::vector<std::string> parts{""};
  for (const char letter : text) {
    if (letter == between) {
      parts.emplace_back();
    } else {
      parts.back() += letter;
    }
  }
  return parts;
}

}  // namespace torsion::engine
