#include "scenes/problem.hpp"

namespace torsion::engine {

std::string to_text(const Problem& problem) {
  std::string text = problem.file + ": ";
  if (!problem.where.empty()) {
    text += problem.where + ": ";
  }
  if (!problem.key.empty()) {
    text += problem.key + " ";
  }
  if (!problem.value.empty()) {
    text += "is " + problem.value + ", ";
  }
  text += problem.expected;
  if (!problem.mend.empty()) {
    text += "\n  to mend it: " + problem.mend;
  }
  return text;
}

std::string to_text(const std::vector<Problem>& problems) {
  std::string text;
  for (const Problem& problem : problems) {
    text += to_text(problem) + "\n";
  }
  return text;
}

}  // namespace torsion::engine
