#include "render/video.hpp"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <string>
#include <system_error>
#include <vector>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace torsion::engine {
namespace {

/// strerror() shares its text between threads; this does not.
std::string error_text(int number) {
  return std::generic_category().message(number);
}

/// The last lines that a process left in a file.
std::string tail_of(int file) {
  std::array<char, 1000> text{};
  const off_t size = ::lseek(file, 0, SEEK_END);
  const off_t from = size > 900 ? size - 900 : 0;
  const ssize_t count = ::pread(file, text.data(), 900, from);
  return count > 0 ? std::string(text.data(), static_cast<std::size_t>(count)) : std::string();
}

/// What ffmpeg is told: raw pictures from standard input, an .mp4 that any player takes.
std::vector<std::string> ffmpeg_words(std::uint32_t width, std::uint32_t height,
                                      double frames_per_second, const std::string& out) {
  const std::string size = std::to_string(width) + "x" + std::to_string(height);
  std::array<char, 40> rate{};
  std::snprintf(rate.data(), rate.size(), "%.9g", frames_per_second);
  return {"ffmpeg",
          "-y",
          "-loglevel",
          "error",
          "-f",
          "rawvideo",
          "-pixel_format",
          "rgba",
          "-video_size",
          size,
          "-framerate",
          rate.data(),
          "-i",
          "-",
          "-vf",
          "crop=trunc(iw/2)*2:trunc(ih/2)*2",
          "-c:v",
          "libx264",
          "-preset",
          "medium",
          "-crf",
          "18",
          "-pix_fmt",
          "yuv420p",
          "-movflags",
          "+faststart",
          "-f",
          "mp4",
          out};
}

void close_if_open(int& file) {
  if (file >= 0) {
    ::close(file);
    file = -1;
  }
}

}  // namespace

struct VideoWriter::Encoder {
  std::filesystem::path path;
  std::filesystem::path temporary;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  pid_t process = -1;
  int pipe = -1;      // to ffmpeg
  int messages = -1;  // an unnamed file with what ffmpeg says

  Encoder() = default;
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;
  Encoder(Encoder&&) = delete;
  Encoder& operator=(Encoder&&) = delete;
  ~Encoder() {
    close_if_open(pipe);
    if (process > 0) {
      ::kill(process, SIGTERM);
      ::waitpid(process, nullptr, 0);
      std::error_code ignored;
      std::filesystem::remove(temporary, ignored);
    }
    close_if_open(messages);
  }

  [[nodiscard]] Error failure(const std::string& what) const {
    return Error{path.string() + ": the video cannot be written: " + what + "\n" +
                 tail_of(messages)};
  }

  /// Waits for ffmpeg's end. True when it did what it should.
  bool ended_well() {
    int status = 0;
    while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {
    }
    process = -1;
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
  }

  Result<Done> start(double frames_per_second);
};

Result<Done> VideoWriter::Encoder::start(double frames_per_second) {
  std::vector<std::string> words =
      ffmpeg_words(width, height, frames_per_second, temporary.string());
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) {
    arguments.push_back(word.data());
  }
  arguments.push_back(nullptr);
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
    return failure(error_text(errno));
  }
  messages = ::open("/tmp", O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  if (messages >= 0) {
    posix_spawn_file_actions_adddup2(&actions, messages, STDERR_FILENO);
  }
  const int failed =
      ::posix_spawnp(&process, "ffmpeg", &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  ::close(ends[0]);
  pipe = ends[1];
  if (failed != 0) {
    process = -1;
    return failure(std::string("ffmpeg does not start: ") + error_text(failed) +
                   "; install the package ffmpeg, or name a folder to get pictures");
  }
  return Done{};
}

VideoWriter::VideoWriter(std::unique_ptr<Encoder> encoder) : encoder_(std::move(encoder)) {}
VideoWriter::VideoWriter(VideoWriter&&) noexcept = default;
VideoWriter& VideoWriter::operator=(VideoWriter&&) noexcept = default;
VideoWriter::~VideoWriter() = default;

Result<VideoWriter> VideoWriter::create(const std::filesystem::path& path, std::uint32_t width,
                                        std::uint32_t height, double frames_per_second) {
  // A write to an ffmpeg that has ended must come back as an error, not end this program.
  std::signal(SIGPIPE, SIG_IGN);
  auto encoder = std::make_unique<Encoder>();
  encoder->path = path;
  encoder->temporary = path;
  encoder->temporary += std::string(".").append(std::to_string(::getpid())).append(".tmp");
  encoder->width = width;
  encoder->height = height;
  const Result<Done> started = encoder->start(frames_per_second);
  if (!started) {
    return started.error();
  }
  return VideoWriter(std::move(encoder));
}

Result<Done> VideoWriter::add(const Image& image) {
  if (image.width != encoder_->width || image.height != encoder_->height) {
    return encoder_->failure("a picture has another size than the first");
  }
  std::size_t done = 0;
  while (done < image.rgba.size()) {
    const ssize_t count =
        ::write(encoder_->pipe, image.rgba.data() + done, image.rgba.size() - done);
    if (count < 0 && errno == EINTR) {
      continue;
    }
    if (count < 0) {
      return encoder_->failure(std::string("ffmpeg stopped: ") + error_text(errno));
    }
    done += static_cast<std::size_t>(count);
  }
  return Done{};
}

Result<Done> VideoWriter::finish() {
  close_if_open(encoder_->pipe);
  const bool well = encoder_->ended_well();
  std::error_code failed;
  if (well) {
    std::filesystem::rename(encoder_->temporary, encoder_->path, failed);
  }
  if (!well || failed) {
    std::error_code ignored;
    std::filesystem::remove(encoder_->temporary, ignored);
    return encoder_->failure(failed ? failed.message() : "ffmpeg failed");
  }
  return Done{};
}

}  // namespace torsion::engine
