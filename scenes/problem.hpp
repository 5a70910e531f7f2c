#pragma once

#include <string>
#include <utility>
#include <vector>

namespace torsion::engine {

/// One thing that is wrong with a scene file, with all that an author needs to mend it.
struct Problem {
  std::string file;   // path as the user gave it
  std::string where;  // 'node "cube"', 'mesh "ball", primitive 0', 'accessors[3]'; empty: the file
  std::string key;    // 'torsion_youngs_modulus', 'accessors[3].bufferView'; may be empty
  std::string value;  // what was found, as in the file; may be empty
  std::string expected;  // what would have been right: 'expected a number above 0 (Pa)'
  std::string mend;      // how to mend it: 'in Blender apply the modifier, then export again'
};

/// Collects the problems of one file.
struct ProblemList {
  std::string file;
  std::vector<Problem>& problems;

  void add(std::string where, std::string key, std::string value, std::string expected,
           std::string mend = {}) const {
    problems.push_back({file, std::move(where), std::move(key), std::move(value),
                        std::move(expected), std::move(mend)});
  }
};

/// `problem` as one or two lines: file: where: key is value, expected ...; to mend it: ...
std::string to_text(const Problem& problem);

/// All of them, one under the other.
std::string to_text(const std::vector<Problem>& problems);

}  // namespace torsion::engine
