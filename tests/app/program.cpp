#include "tests/app/program.hpp"

#include <csignal>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/support/paths.hpp"

namespace torsion::engine::test {

Process::Process(const std::vector<std::string>& words) {
  const std::string out = folder_ / "out";
  const std::string err = folder_ / "err";
  std::vector<std::string> all = words;
  std::vector<char*> arguments;
  arguments.reserve(all.size() + 1);
  for (std::string& word : all) {
    arguments.push_back(word.data());
  }
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  constexpr int kFlags = O_WRONLY | O_CREAT | O_TRUNC;
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out.c_str(), kFlags, 0600);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, err.c_str(), kFlags, 0600);
  const int failed =
      ::posix_spawnp(&id_, all[0].c_str(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) {
    throw std::runtime_error("cannot run " + all[0]);
  }
}

Process::~Process() {
  if (id_ != 0) {
    send(SIGKILL);
    wait();
  }
}

void Process::send(int signal) const {
  ::kill(id_, signal);
}

Ran Process::wait() {
  int status = 0;
  ::waitpid(id_, &status, 0);
  id_ = 0;
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status), read_text(folder_ / "out"),
          read_text(folder_ / "err")};
}

std::vector<std::string> torsion(std::vector<std::string> words) {
  words.insert(words.begin(), build_folder() + "/torsion");
  return words;
}

Ran run_torsion(const std::vector<std::string>& words) {
  return Process(torsion(words)).wait();
}

std::string scene(const std::string& name) {
  return shipped_scene(name);
}

Folder::Folder() {
  std::string name = (std::filesystem::temp_directory_path() / "torsion_test_XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) {
    throw std::runtime_error("cannot make " + name);
  }
  path_ = name;
}

Folder::~Folder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::string read_text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

void write_text(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields(1);
  for (const char c : line) {
    if (c == ',') {
      fields.emplace_back();
    } else {
      fields.back() += c;
    }
  }
  return fields;
}

}  // namespace torsion::engine::test
