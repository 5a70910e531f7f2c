#pragma once

#include <string>
#include <vector>

namespace torsion {

/// One thing that is wrong with a scene file, with all that an author needs to mend it.
struct Problem {
  std::string file;   // path as the user gave it
  std::string where;  // 'node "cube"', 'mesh "ball", primitive 0', 'accessors[3]'; empty: the file
  std::string key;    // 'torsion_youngs_modulus', 'accessors[3].bufferView'; may be empty
  std::string value;  // what was found, as in the file; may be empty
  std::string expected;  // what would have been right: 'a number above 0 (Pa)'
  std::string mend;      // how to mend it: 'in Blender apply the modifier, then export again'
};

/// `problem` as one or two lines: file: where: key is value, expected ...; mend.
std::string to_text(const Problem& problem);

/// All of them, one under the other.
std::string to_text(const std::vector<Problem>& problems);

}  // namespace torsion
