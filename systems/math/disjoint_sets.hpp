#pragma once

// Rows in disjoint sets, each with a root; parent[row] leads there. (Cormen, Leiserson, Rivest and
// Stein, Introduction to Algorithms, chapter 21.) At first each row is its own parent.

#include <algorithm>
#include <cstdint>
#include <span>

namespace torsion::engine {

/// Shortens the path on its way.
inline std::uint32_t root_of(std::span<std::uint32_t> parent, std::uint32_t row) {
  while (parent[row] != row) {
    parent[row] = parent[parent[row]];
    row = parent[row];
  }
  return row;
}

/// Makes one set of two. The smaller row becomes the root, so that the outcome does not depend on
/// the order of the links.
/// @return true when they were not linked before
inline bool link(std::span<std::uint32_t> parent, std::uint32_t a, std::uint32_t b) {
  const std::uint32_t root_a = root_of(parent, a);
  const std::uint32_t root_b = root_of(parent, b);
  parent[std::max(root_a, root_b)] = std::min(root_a, root_b);
  return root_a != root_b;
}

}  // namespace torsion::engine
