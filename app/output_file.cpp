#include "app/output_file.hpp"

#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "ecs/assert.hpp"

namespace torsion::engine {
namespace {

Error cannot_write(const std::filesystem::path& path, const std::string& why) {
  return Error{path.string() + ": cannot be written: " + why + "; choose another place or free it"};
}

/// What a code of errno means.
std::string said_by_system(int code) {
  return std::error_code(code, std::generic_category()).message();
}

/// The descriptor that a name such as /dev/stdout stands for; -1 for other names.
int descriptor_named(const std::filesystem::path& path) {
  const std::string name = path.lexically_normal().string();
  if (name == "/dev/stdout" || name == "/dev/stderr") {
    return name == "/dev/stdout" ? STDOUT_FILENO : STDERR_FILENO;
  }
  for (const std::string_view folder : {"/dev/fd/", "/proc/self/fd/"}) {
    int descriptor = -1;
    const char* const end = name.data() + name.size();
    if (name.starts_with(folder) &&
        std::from_chars(name.data() + folder.size(), end, descriptor).ptr == end) {
      return descriptor;
    }
  }
  return -1;
}

}  // namespace

Result<Done> make_parent_folder(const std::filesystem::path& path) {
  const std::filesystem::path folder = path.parent_path();
  std::error_code failed;
  if (!folder.empty()) {
    std::filesystem::create_directories(folder, failed);
  }
  if (failed) {
    return cannot_write(path, failed.message());
  }
  return Done{};
}

Result<OutputFile> OutputFile::open_as_it_is(const std::filesystem::path& path) {
  // One of this process's own goes on where it is; a pipe that nobody reads is no wait but an
  // error.
  const int own = descriptor_named(path);
  const int descriptor = own >= 0
                             ? ::fcntl(own, F_DUPFD_CLOEXEC, 0)
                             : ::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  if (descriptor < 0) {
    return cannot_write(path, errno == ENXIO ? "nobody reads from it" : said_by_system(errno));
  }
  if (own < 0) {
    ::fcntl(descriptor, F_SETFL, ::fcntl(descriptor, F_GETFL) & ~O_NONBLOCK);
  }
  std::FILE* file = ::fdopen(descriptor, "wb");
  if (file == nullptr) {
    const int code = errno;
    ::close(descriptor);
    return cannot_write(path, said_by_system(code));
  }
  OutputFile output(path, {}, file);
  output.as_it_is_ = true;
  return output;
}

Result<OutputFile> OutputFile::create(const std::filesystem::path& path) {
  const Result<Done> folder = make_parent_folder(path);
  if (!folder) {
    return folder.error();
  }
  if (std::filesystem::is_directory(path)) {
    return cannot_write(path, "it is a folder");
  }
  std::error_code failed;
  const std::filesystem::file_status status = std::filesystem::status(path, failed);
  if (descriptor_named(path) >= 0 ||
      (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))) {
    return open_as_it_is(path);
  }
  std::filesystem::path place = path;
  if (std::filesystem::is_symlink(path, failed)) {
    place = std::filesystem::weakly_canonical(path, failed);
    if (failed) {
      return cannot_write(path, failed.message());
    }
  }
  // Its own, even beside one that is being written to the same place.
  std::filesystem::path temporary;
  std::FILE* file = nullptr;
  for (int number = 0; file == nullptr; ++number) {
    temporary = place;
    temporary += fmt::format(".{}.{}.tmp", ::getpid(), number);
    file = std::fopen(temporary.c_str(), "w+bx");
    if (file == nullptr && errno != EEXIST) {
      return cannot_write(path, said_by_system(errno));
    }
  }
  return OutputFile(place, std::move(temporary), file);
}

Result<OutputFile> OutputFile::create_unnamed() {
  const char* const chosen = std::getenv("TMPDIR");  // NOLINT(concurrency-mt-unsafe): no setenv
  const std::filesystem::path folder = chosen != nullptr && *chosen != '\0' ? chosen : "/var/tmp";
  std::string name = folder / "torsion-XXXXXX";
  const int descriptor = ::mkostemp(name.data(), O_CLOEXEC);
  if (descriptor < 0) {
    return cannot_write(folder, said_by_system(errno));
  }
  ::unlink(name.c_str());
  std::FILE* file = ::fdopen(descriptor, "w+b");
  if (file == nullptr) {
    const int code = errno;
    ::close(descriptor);
    return cannot_write(folder, said_by_system(code));
  }
  return OutputFile(folder, {}, file);
}

OutputFile::OutputFile(std::filesystem::path path, std::filesystem::path temporary, std::FILE* file)
    : path_(std::move(path)), temporary_(std::move(temporary)), file_(file) {}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : path_(std::move(other.path_)),
      temporary_(std::move(other.temporary_)),
      file_(std::exchange(other.file_, nullptr)),
      as_it_is_(other.as_it_is_),
      failed_(other.failed_),
      why_(other.why_) {}

OutputFile& OutputFile::operator=(OutputFile&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(temporary_, other.temporary_);
  std::swap(file_, other.file_);
  std::swap(as_it_is_, other.as_it_is_);
  std::swap(failed_, other.failed_);
  std::swap(why_, other.why_);
  return *this;
}

OutputFile::~OutputFile() {
  if (file_ != nullptr) {
    std::fclose(file_);
    if (!temporary_.empty()) {
      std::error_code ignored;
      std::filesystem::remove(temporary_, ignored);
    }
  }
}

Result<std::filesystem::path> OutputFile::place() const {
  if (temporary_.empty()) {
    return cannot_write(path_, "it is no plain file");
  }
  return temporary_;
}

void OutputFile::write(std::string_view bytes) {
  if (failed_) {
    return;  // a hole in the middle would be worse than an end
  }
  errno = 0;
  failed_ = std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size();
  why_ = failed_ ? errno : 0;
}

std::string OutputFile::problem() const {
  return failed_ ? cannot_write(path_, why_ != 0 ? said_by_system(why_) : "the disk is full").text
                 : "";
}

void OutputFile::flush() {
  if (!failed_) {
    errno = 0;
    failed_ = std::fflush(file_) != 0;
    why_ = failed_ ? errno : 0;
  }
}

Result<Done> OutputFile::copy_to(OutputFile& to) {
  flush();
  if (failed_) {
    return Error{problem()};
  }
  std::vector<char> bytes(1U << 20U);
  off_t at = 0;
  ssize_t size = 0;
  while ((size = ::pread(::fileno(file_), bytes.data(), bytes.size(), at)) > 0) {
    to.write({bytes.data(), static_cast<std::size_t>(size)});
    at += size;
  }
  if (size < 0) {
    return Error{path_.string() + ": cannot be read: " + said_by_system(errno)};
  }
  return Done{};
}

Result<Done> OutputFile::commit() {
  TORSION_ASSERT(!temporary_.empty() || as_it_is_);
  flush();
  failed_ = std::fclose(std::exchange(file_, nullptr)) != 0 || failed_;
  if (as_it_is_) {
    return failed_ ? Result<Done>(Error{problem()}) : Result<Done>(Done{});
  }
  std::error_code renaming;
  if (!failed_) {
    std::filesystem::rename(temporary_, path_, renaming);
  }
  if (failed_ || renaming) {
    std::error_code ignored;
    std::filesystem::remove(temporary_, ignored);
    return renaming ? cannot_write(path_, renaming.message()) : Error{problem()};
  }
  return Done{};
}

Result<Done> OutputFile::commit_all(std::span<OutputFile> files) {
  for (OutputFile& file : files) {
    file.flush();
    if (file.failed_) {
      return Error{file.problem()};
    }
  }
  for (OutputFile& file : files) {
    const Result<Done> done = file.commit();
    if (!done) {
      return done.error();
    }
  }
  return Done{};
}

Result<Done> try_files(std::span<const std::filesystem::path> paths) {
  for (const std::filesystem::path& path : paths) {
    const Result<OutputFile> file = OutputFile::create(path);
    if (!file) {
      return file.error();
    }
  }
  return Done{};
}

Result<Done> write_files(std::span<const FileText> files) {
  std::vector<OutputFile> outputs;
  for (const FileText& each : files) {
    Result<OutputFile> output = OutputFile::create(each.path);
    if (!output) {
      return output.error();
    }
    output.value().write(each.text);
    outputs.push_back(std::move(output).value());
  }
  return OutputFile::commit_all(outputs);
}

}  // namespace torsion::engine
