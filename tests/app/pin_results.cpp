// Renews this machine's lines of the file of pinned results and leaves those of other instruction
// sets: pin_results FILE.

#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include "tests/app/run_digest.hpp"

int main(int count, char** arguments) {
  using namespace torsion::engine::test;
  const std::string path = count > 1 ? arguments[1] : pinned_file();
  std::vector<std::string> lines;
  {
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);) {
      if (line.rfind(instruction_set() + " ", 0) != 0) {
        lines.push_back(line);
      }
    }
  }
  for (const PinnedRun& run : pinned_runs()) {
    lines.push_back(pinned_line(run, digest_of(run)));
    std::printf("%s\n", lines.back().c_str());
  }
  std::ofstream file(path);
  for (const std::string& line : lines) {
    file << line << '\n';
  }
  return file.good() ? 0 : 1;
}
