#include "app/report/scene_picture.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <glm/geometric.hpp>
#include <unistd.h>

#include "app/picture_run.hpp"
#include "app/report/run_case.hpp"
#include "render/image_io.hpp"

namespace torsion::engine {
namespace {

constexpr ModelPair kDrawnModels{ContactModel::kPatch, BodyModel::kNone, 16};

/// The bytes of an image as a PNG file, by way of a file that is gone after.
Result<std::string> png_bytes(const Image& image) {
  const std::filesystem::path path = std::filesystem::temp_directory_path() /
                                     ("torsion_picture_" + std::to_string(::getpid()) + ".png");
  const Result<Done> written = write_png(image, path);
  if (!written) {
    return written.error();
  }
  std::ostringstream bytes;
  {
    std::ifstream file(path, std::ios::binary);
    bytes << file.rdbuf();
  }
  std::error_code ignored;
  std::filesystem::remove(path, ignored);
  return bytes.str();
}

}  // namespace

Result<std::string> scene_picture(const ReferenceCase& reference_case) {
  const auto farthest = std::ranges::max_element(reference_case.path, {}, &PathPoint::abscissa);
  Result<Simulation> simulation =
      simulate_to(reference_case, kDrawnModels,
                  static_cast<std::size_t>(farthest - reference_case.path.begin()));
  if (!simulation) {
    return simulation.error();
  }
  Session session{reference_case.scene, std::move(simulation).value(), {}};
  PictureRun::Options options;
  options.width = 720;
  options.height = 480;
  options.overlay = false;
  options.draw.heat_map = HeatMap::kTwist;
  Result<PictureRun> run = PictureRun::create(session, options);
  if (!run) {
    return run.error();
  }
  constexpr double kInPicture = 1.6;  // the arrow of a full force would reach beyond its top
  const Wrench& wrench = session.simulation.world.state.tools.at<ToolWrench>(0).total;
  run.value().set_scales({std::max(farthest->abscissa, 1e-3),
                          1.0,
                          {std::max(kInPicture * glm::length(wrench.force), 1e-9),
                           std::max(glm::length(wrench.torque), 1e-9), 1.0}});
  const Result<Image> image = run.value().draw(session);
  return image ? png_bytes(image.value()) : Result<std::string>(image.error());
}

}  // namespace torsion::engine
