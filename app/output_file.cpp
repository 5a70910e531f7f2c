#include "app/output_file.hpp"

#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

namespace torsion {
namespace {

Error cannot_write(const std::filesystem::path& path, const std::string& why) {
  return Error{path.string() + ": cannot be written: " + why + "; choose another place or free it"};
}

/// What a code of errno means.
std::string said_by_system(int code) {
  return std::error_code(code, std::generic_category()).message();
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

Result<OutputFile> OutputFile::create(const std::filesystem::path& path) {
  const Result<Done> folder = make_parent_folder(path);
  if (!folder) {
    return folder.error();
  }
  if (std::filesystem::is_directory(path)) {
    return cannot_write(path, "it is a folder");
  }
  std::filesystem::path temporary = path;
  temporary += fmt::format(".{}.tmp", ::getpid());
  std::FILE* file = std::fopen(temporary.c_str(), "wb");
  if (file == nullptr) {
    return cannot_write(path, said_by_system(errno));
  }
  return OutputFile(path, std::move(temporary), file);
}

OutputFile::OutputFile(std::filesystem::path path, std::filesystem::path temporary, std::FILE* file)
    : path_(std::move(path)), temporary_(std::move(temporary)), file_(file) {}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : path_(std::move(other.path_)),
      temporary_(std::move(other.temporary_)),
      file_(std::exchange(other.file_, nullptr)),
      failed_(other.failed_),
      why_(other.why_) {}

OutputFile& OutputFile::operator=(OutputFile&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(temporary_, other.temporary_);
  std::swap(file_, other.file_);
  std::swap(failed_, other.failed_);
  std::swap(why_, other.why_);
  return *this;
}

OutputFile::~OutputFile() {
  if (file_ != nullptr) {
    std::fclose(file_);
    std::error_code ignored;
    std::filesystem::remove(temporary_, ignored);
  }
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

Result<Done> OutputFile::commit() {
  if (!failed_) {
    errno = 0;
    failed_ = std::fflush(file_) != 0;
    why_ = failed_ ? errno : 0;
  }
  failed_ = std::fclose(std::exchange(file_, nullptr)) != 0 || failed_;
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

}  // namespace torsion
