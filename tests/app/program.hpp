#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <sys/types.h>

namespace torsion::engine::test {

/// What a run of the program torsion left.
struct Ran {
  int exit_code = -1;  // minus the signal's number when it was killed
  std::string out;
  std::string err;
};

/// A shipped scene.
std::string scene(const std::string& name);

/// An empty folder that goes with the object.
class Folder {
 public:
  Folder();
  ~Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  Folder(Folder&&) = delete;
  Folder& operator=(Folder&&) = delete;
  [[nodiscard]] std::string operator/(const std::string& name) const {
    return (path_ / name).string();
  }
  [[nodiscard]] bool empty() const { return std::filesystem::is_empty(path_); }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// A program that runs beside the test. Ends with the object, however that goes.
class Process {
 public:
  /// @param words  the program's path and what it is told
  explicit Process(const std::vector<std::string>& words);
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  Process(Process&&) = delete;
  Process& operator=(Process&&) = delete;

  void send(int signal) const;
  /// Waits until it ends.
  Ran wait();

 private:
  Folder folder_;
  pid_t id_ = 0;  // 0: it has ended
};

/// The words of the built program with these behind it.
std::vector<std::string> torsion(std::vector<std::string> words);

/// Runs the built program with these words.
Ran run_torsion(const std::vector<std::string>& words);

std::string read_text(const std::string& path);
void write_text(const std::string& path, const std::string& text);

/// The fields of a line of a .csv, empty ones too.
std::vector<std::string> fields_of(const std::string& line);

}  // namespace torsion::engine::test
