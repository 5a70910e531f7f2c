#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "app/live/recording.hpp"
#include "ecs/result.hpp"

namespace torsion::engine {

// A recording in a file: magic, version, a JSON object with all but the entries, the entries as
// they lie in memory, as many as there is room for before the checksum (XXH3) of all that. In this
// machine's byte order, which the magic shows.

/// Writes a recording while it is made, by way of a temporary file: it takes the same memory
/// however long it gets, and `path` is never half-written. Not for the physics thread: it does what
/// a disk does.
class RecordingWriter {
 public:
  /// @param head  the recording without its entries
  static Result<RecordingWriter> create(const std::filesystem::path& path, const Recording& head);
  /// One that is not for a file of its own, but for copies of what it has so far.
  static Result<RecordingWriter> create_unnamed(const Recording& head);

  RecordingWriter(RecordingWriter&&) noexcept;
  RecordingWriter& operator=(RecordingWriter&&) noexcept;
  RecordingWriter(const RecordingWriter&) = delete;
  RecordingWriter& operator=(const RecordingWriter&) = delete;
  ~RecordingWriter();  // takes the temporary file away unless it was finished

  /// Allocates nothing. After a failure, such as a full disk, it does nothing.
  void add(const InputEntry& entry);
  /// Why the writing failed; empty as long as it has not.
  [[nodiscard]] std::string problem() const;
  /// Writes what there is so far to a file of its own, as a whole recording.
  Result<Done> save_copy(const std::filesystem::path& path);
  /// @pre it is not unnamed
  Result<Done> finish();

 private:
  struct State;
  explicit RecordingWriter(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Writes all of it at once, in the same way.
Result<Done> save_recording(const Recording& recording, const std::filesystem::path& path);

/// Fails on anything that save_recording cannot have written, and says what it is.
Result<Recording> load_recording(const std::filesystem::path& path);

}  // namespace torsion::engine
