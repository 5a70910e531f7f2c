#include "scenes/file_bytes.hpp"

#include <algorithm>
#include <cerrno>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace torsion::engine {
namespace {

/// Closes a file descriptor at the end of its scope.
struct OpenFile {
  int descriptor;
  explicit OpenFile(const std::filesystem::path& path)
      : descriptor(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)) {}
  ~OpenFile() {
    if (descriptor >= 0) {
      ::close(descriptor);
    }
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  OpenFile(OpenFile&&) = delete;
  OpenFile& operator=(OpenFile&&) = delete;
};

std::string last_error() {
  return std::error_code(errno, std::generic_category()).message();
}

Error cannot_read(const std::filesystem::path& path, const std::string& why) {
  return Error{path.string() + " cannot be read: " + why};
}

/// %41 -> A; a text with a broken or forbidden escape is returned empty.
std::string decoded(const std::string& uri) {
  std::string text;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] != '%') {
      text += uri[i];
      continue;
    }
    const std::string digits = uri.substr(i + 1, 2);
    if (digits.size() < 2 || digits.find_first_not_of("0123456789abcdefABCDEF") != digits.npos) {
      return {};
    }
    text += static_cast<char>(std::stoi(digits, nullptr, 16));
    i += 2;
  }
  return text;
}

}  // namespace

Result<std::vector<unsigned char>> read_file_bytes(const std::filesystem::path& path,
                                                   std::uint64_t largest) {
  const OpenFile file(path);
  if (file.descriptor < 0) {
    return cannot_read(path, last_error());
  }
  struct stat status {};
  if (::fstat(file.descriptor, &status) != 0) {
    return cannot_read(path, last_error());
  }
  if (!S_ISREG(status.st_mode)) {
    return cannot_read(path, "it is not a regular file");
  }
  const auto size = static_cast<std::uint64_t>(status.st_size);
  if (size > largest) {
    return cannot_read(path, "it has " + std::to_string(size) + " bytes, at most " +
                                 std::to_string(largest) + " are allowed");
  }
  std::vector<unsigned char> bytes(size);
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t count = ::read(file.descriptor, bytes.data() + done, bytes.size() - done);
    if (count < 0 && errno == EINTR) {
      continue;
    }
    if (count <= 0) {
      return cannot_read(path, count < 0 ? last_error() : "it became shorter");
    }
    done += static_cast<std::size_t>(count);
  }
  return bytes;
}

Result<std::filesystem::path> path_inside(const std::filesystem::path& folder,
                                          const std::string& uri) {
  const Error outside{"\"" + uri + "\" leads out of the scene's folder"};
  const std::string name = decoded(uri);
  const bool odd = name.empty() || name.find('\0') != name.npos || name.find('\\') != name.npos ||
                   name.find(':') != name.npos;
  const std::filesystem::path relative(name);
  const auto is_up = [](const std::filesystem::path& part) {
    return part == "..";
  };
  if (odd || relative.is_absolute() || std::ranges::any_of(relative, is_up)) {
    return outside;
  }
  std::error_code failed;
  const std::filesystem::path root = std::filesystem::canonical(folder, failed);
  const std::filesystem::path target =
      failed ? root : std::filesystem::weakly_canonical(root / relative, failed);
  const auto [end, rest] = std::ranges::mismatch(root, target);
  if (failed || end != root.end() || rest == target.end()) {
    return outside;
  }
  return target;
}

}  // namespace torsion::engine
