#pragma once

#include <cstdio>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "ecs/result.hpp"

namespace torsion::engine {

/// A file that is there whole or not at all: written under another name beside its place and
/// renamed by commit(). What was there before stays until then. What is no plain file (a device, a
/// pipe, a socket) is never replaced: it is written to as it is. A link stays, its target is
/// replaced.
class OutputFile {
 public:
  static Result<OutputFile> create(const std::filesystem::path& path);
  /// One without a name, which ends with the object: in $TMPDIR, else in /var/tmp, which the file
  /// system hierarchy keeps for large ones (/tmp may be memory).
  static Result<OutputFile> create_unnamed();

  OutputFile(OutputFile&& other) noexcept;
  OutputFile& operator=(OutputFile&& other) noexcept;
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  ~OutputFile();  // takes the temporary file away unless it was committed

  /// Where the bytes are until commit(), for a library that writes the file by itself. Fails where
  /// the file is written to as it is: such a library goes to and fro in it.
  [[nodiscard]] Result<std::filesystem::path> place() const;

  /// Remembers a failure for commit(), so that a loop need not check every line.
  void write(std::string_view bytes);
  /// Why the writing failed; empty as long as it has not.
  [[nodiscard]] std::string problem() const;

  /// Writes all that is here so far behind what is in `to`.
  Result<Done> copy_to(OutputFile& to);

  /// Flushes and renames. Fails when anything since create() failed.
  /// @pre it has a name
  Result<Done> commit();
  /// Commits all of them or none: renames only once every file is there whole. Beyond that it can
  /// fail only where a place is taken away or filled with a folder at that very moment.
  static Result<Done> commit_all(std::span<OutputFile> files);

 private:
  OutputFile(std::filesystem::path path, std::filesystem::path temporary, std::FILE* file);
  /// To a place that holds something else than a plain file.
  static Result<OutputFile> open_as_it_is(const std::filesystem::path& path);
  void flush();
  std::filesystem::path path_;
  std::filesystem::path temporary_;  // empty: it has no name, or is written to as it is
  std::FILE* file_ = nullptr;
  bool as_it_is_ = false;
  bool failed_ = false;
  int why_ = 0;  // of errno, when it failed
};

/// A text and the file that it is to be.
struct FileText {
  std::filesystem::path path;
  std::string text;
};

/// Whether all of them can be written, before the work whose results they are. Leaves nothing but
/// folders.
Result<Done> try_files(std::span<const std::filesystem::path> paths);

/// All of them or none.
Result<Done> write_files(std::span<const FileText> files);

/// The folder in which `path` will lie, made if it is not there.
Result<Done> make_parent_folder(const std::filesystem::path& path);

}  // namespace torsion::engine
