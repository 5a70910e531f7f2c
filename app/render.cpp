#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "app/commands.hpp"
#include "app/output_file.hpp"
#include "app/picture_run.hpp"
#include "app/progress.hpp"
#include "app/scene_colors.hpp"
#include "render/image_io.hpp"
#include "render/video.hpp"

namespace torsion::engine {
namespace {

// Every how many steps the twist is looked at for the end of its scale: it changes slowly.
constexpr std::uint64_t kScaleStride = 100;

struct RenderOptions {
  SceneOptions scene;
  std::string out;
  double at = -1.0;       // s; negative: not one moment
  double seconds = -1.0;  // s; negative: to the end of the longest animation
  double frames_per_second = 30.0;
  std::string size = "1280x720";
  std::string heat;  // empty: as the scene says
  bool no_overlay = false;
  bool no_arrows = false;
  bool no_grid = false;
  bool quiet = false;
  PictureRun::Options picture;
};

/// Where the pictures go: one PNG, PNGs in a folder, or a video.
class PictureSink {
 public:
  virtual ~PictureSink() = default;
  virtual Result<Done> add(const Image& image) = 0;
  virtual Result<Done> finish() { return Done{}; }
};

class OnePicture : public PictureSink {
 public:
  explicit OnePicture(std::filesystem::path path) : path_(std::move(path)) {}
  Result<Done> add(const Image& image) override { return write_png(image, path_); }

 private:
  std::filesystem::path path_;
};

class PictureFolder : public PictureSink {
 public:
  explicit PictureFolder(std::filesystem::path folder) : folder_(std::move(folder)) {}
  Result<Done> add(const Image& image) override {
    return write_png(image, folder_ / fmt::format("{:04d}.png", count_++));
  }

 private:
  std::filesystem::path folder_;
  int count_ = 0;
};

class Video : public PictureSink {
 public:
  explicit Video(VideoWriter writer) : writer_(std::move(writer)) {}
  Result<Done> add(const Image& image) override { return writer_.add(image); }
  Result<Done> finish() override { return writer_.finish(); }

 private:
  VideoWriter writer_;
};

bool one_picture(const RenderOptions& options) {
  return options.at >= 0.0;
}

Result<std::unique_ptr<PictureSink>> open_sink(const RenderOptions& options) {
  const std::filesystem::path path(options.out);
  const std::string extension = path.extension().string();
  if (extension == ".mp4" || extension == ".png") {
    const Result<Done> folder = make_parent_folder(path);
    if (!folder) {
      return folder.error();
    }
  }
  if (extension == ".mp4") {
    Result<VideoWriter> video = VideoWriter::create(
        path, options.picture.width, options.picture.height, options.frames_per_second);
    if (!video) {
      return video.error();
    }
    return std::unique_ptr<PictureSink>(std::make_unique<Video>(std::move(video).value()));
  }
  if (extension == ".png") {
    return std::unique_ptr<PictureSink>(std::make_unique<OnePicture>(path));
  }
  const Result<Done> folder = make_parent_folder(path / "0000.png");
  if (!folder) {
    return folder.error();
  }
  return std::unique_ptr<PictureSink>(std::make_unique<PictureFolder>(path));
}

/// Steps to the moment of frame `frame` and a step past it, so that the frame's time is the last
/// step's.
void step_to_frame(Session& session, double time) {
  const std::uint64_t wanted = steps_in(session, time) + 1;
  while (session.simulation.world.state.clock.step < wanted) {
    step_scripted(session);
  }
}

Result<Done> draw_all(Session& session, const RenderOptions& options, double seconds,
                      PictureRun& run, PictureSink& sink) {
  Progress progress("drawing", options.quiet);
  const double first = one_picture(options) ? options.at : 0.0;
  const int frames =
      one_picture(options)
          ? 1
          : static_cast<int>(std::max(1.0, std::round(seconds * options.frames_per_second)));
  for (int frame = 0; frame < frames; ++frame) {
    step_to_frame(session, first + frame / options.frames_per_second);
    const Result<Image> image = run.draw(session);
    if (!image) {
      return image.error();
    }
    const Result<Done> added = sink.add(image.value());
    if (!added) {
      return added.error();
    }
    progress.show(static_cast<double>(frame + 1) / frames);
  }
  return sink.finish();
}

/// The scales of the whole animation also for one moment, so that single pictures compare.
PictureScales scales_of_run(Session& session, const RenderOptions& options, double seconds) {
  Progress progress("finding the scales", options.quiet);
  const double end = one_picture(options) ? std::max(options.at, session.scene.duration) : seconds;
  return find_scales(session, steps_in(session, end) + 1, kScaleStride, progress);
}

int render(const RenderOptions& options) {
  Result<Session> opened = open_session(options.scene.scene, options.scene.prepare_options(),
                                        options.quiet, options.scene.settings);
  if (!opened) {
    return fail(opened.error().text);
  }
  Session& session = opened.value();
  PictureRun::Options picture = options.picture;
  const std::string colors = options.heat.empty() ? session.scene.view.colors : options.heat;
  picture.draw.heat_map =
      colors == "none" ? HeatMap::kNone : heat_map_of(colors).value_or(HeatMap::kTwist);
  // What can fail without a step taken comes first.
  Result<PictureRun> run = PictureRun::create(session, picture);
  if (!run) {
    return fail(run.error().text);
  }
  Result<std::unique_ptr<PictureSink>> sink = open_sink(options);
  if (!sink) {
    return fail(sink.error().text);
  }
  const double seconds = options.seconds < 0.0 ? session.scene.duration : options.seconds;
  run.value().set_scales(scales_of_run(session, options, seconds));
  const Result<Done> done = draw_all(session, options, seconds, run.value(), *sink.value());
  if (!done) {
    return fail(done.error().text);
  }
  if (!options.quiet) {
    fmt::print("{}\n", options.out);
  }
  return kDone;
}

/// WxH into the picture's size. False where it is not two numbers that a picture can have.
bool read_size(const std::string& text, PictureRun::Options& picture) {
  unsigned int width = 0;
  unsigned int height = 0;
  char rest = 0;
  const int read = std::sscanf(text.c_str(), "%5ux%5u%c", &width, &height, &rest);
  if (read != 2 || width < 16 || height < 16 || width > 16384 || height > 16384) {
    return false;
  }
  picture.width = width;
  picture.height = height;
  return true;
}

int read_and_render(RenderOptions& options) {
  if (!read_size(options.size, options.picture)) {
    fmt::print(stderr, "--size {}: expected WIDTHxHEIGHT in pixels, 16 to 16384\n", options.size);
    return kUsage;
  }
  const std::filesystem::path out(options.out);
  const std::string extension = out.extension().string();
  if (extension != ".png" && extension != ".mp4" && !extension.empty() &&
      !std::filesystem::is_directory(out)) {
    fmt::print(stderr,
               "--out {}: expected NAME.png, NAME.mp4, or a folder: there, or ending in /, or "
               "without a dot in its name\n",
               options.out);
    return kUsage;
  }
  if ((extension == ".png") != one_picture(options)) {
    fmt::print(stderr, "--out {}: a .png needs --at, and --at needs a .png\n", options.out);
    return kUsage;
  }
  options.picture.draw.arrows = !options.no_arrows;
  options.picture.draw.grid = !options.no_grid;
  options.picture.overlay = !options.no_overlay;
  return render(options);
}

}  // namespace

void add_render(CLI::App& app, Command& command) {
  CLI::App* subcommand =
      app.add_subcommand("render", "Draw a scene to a PNG, a folder of PNGs, or an .mp4");
  auto options = std::make_shared<RenderOptions>();
  options->scene.add_to(*subcommand);
  options->scene.add_settings_to(*subcommand);
  subcommand->add_option("--out", options->out, "NAME.png with --at, NAME.mp4, or a folder")
      ->required();
  subcommand->add_option("--at", options->at, "The one moment to draw (s)")
      ->check(CLI::Range(0.0, 1e6));
  subcommand->add_option("--fps", options->frames_per_second, "Pictures a second")
      ->check(CLI::Range(0.001, 1000.0));
  subcommand->add_option("--seconds", options->seconds, "How long; else the animation's length")
      ->check(CLI::Range(0.0, 1e6));
  subcommand->add_option("--size", options->size, "WIDTHxHEIGHT in pixels, 1280x720 unless said");
  subcommand->add_option("--camera", options->picture.camera, "A camera node of the file");
  subcommand
      ->add_option("--heat", options->heat,
                   "What colours show: twist, pressure or none; else as the scene says, or twist")
      ->check(CLI::IsMember({"twist", "pressure", "none"}));
  subcommand->add_flag("--no-overlay", options->no_overlay, "No text, scale or legend");
  subcommand->add_flag("--no-arrows", options->no_arrows, "No arrows for force and torque");
  subcommand->add_flag("--no-grid", options->no_grid, "No material grid");
  subcommand->add_flag("--quiet", options->quiet, "Print nothing but errors");
  subcommand->callback([options, &command] {
    command = [options] {
      return read_and_render(*options);
    };
  });
}

}  // namespace torsion::engine
