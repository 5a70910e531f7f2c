#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>
#include <tiny_gltf.h>

#include "scenes/conventions.hpp"
#include "scenes/problem.hpp"

namespace torsion::engine {

/// How a message calls element `row` of an array: node "cube", or nodes[3] where it has no name.
std::string called(std::string_view kind, std::string_view array, std::size_t row,
                   const std::string& name);

/// The torsion_ keys that hold for one node (the material's, then the mesh's over them, then the
/// node's) or for the scene.
class NodeKeys {
 public:
  /// Adds the keys of `extras`, which win over those that are there. Unknown torsion_ keys and
  /// values of the wrong kind or out of range are problems and left out.
  void add(const tinygltf::Value& extras, const std::string& where, const ProblemList& problems);

  /// Notes every key that a node of this role does not have.
  void check_role(Role role, const ProblemList& problems) const;

  [[nodiscard]] std::optional<double> number(const std::string& key) const;
  [[nodiscard]] std::optional<std::string> text(const std::string& key) const;
  [[nodiscard]] std::optional<bool> flag(const std::string& key) const;
  [[nodiscard]] std::optional<glm::dvec3> vector(const std::string& key) const;
  /// Where the key was found; empty when it was not.
  [[nodiscard]] std::string where(const std::string& key) const;

 private:
  struct Entry {
    tinygltf::Value value;
    std::string where;
  };
  std::map<std::string, Entry> entries_;
};

/// The role that a node says it has; problems are left to NodeKeys::add.
Role role_of(const tinygltf::Value& extras);

/// The known word nearest to `word`, when it is near enough to be what was meant: not more than a
/// third of the letters, rounded up, are wrong.
std::optional<std::string> did_you_mean(std::string_view word,
                                        const std::vector<std::string_view>& known);

}  // namespace torsion::engine
