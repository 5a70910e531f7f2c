#pragma once

#include <string>

namespace torsion::engine {

/// Where and with what the program ran, in words.
struct Machine {
  std::string processor;
  unsigned cores = 0;
  double load = 0.0;  // processes that ran or waited in the last minute
  std::string system;
  std::string compiler;
  std::string build;
  std::string date;  // UTC
};

Machine this_machine();

}  // namespace torsion::engine
