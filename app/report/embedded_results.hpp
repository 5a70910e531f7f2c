#pragma once

#include <span>
#include <string_view>

namespace torsion::engine {

/// A file that was put into the program when it was built.
struct EmbeddedFile {
  std::string_view name;  // without folder and extension
  std::string_view text;
};

/// tests/reference/finite_elements/results/*.csv, by name.
std::span<const EmbeddedFile> element_results();

/// tests/reference/boundary_elements/*.csv, by name.
std::span<const EmbeddedFile> boundary_element_results();

}  // namespace torsion::engine
