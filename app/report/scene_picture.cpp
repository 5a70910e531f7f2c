#include "app/report/scene_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <glm/geometric.hpp>
#include <unistd.h>

#include "app/deformed_scene.hpp"
#include "app/picture_run.hpp"
#include "app/report/coarse_mesh.hpp"
#include "app/report/run_case.hpp"
#include "app/run_page/run_page.hpp"
#include "render/box.hpp"
#include "render/image_io.hpp"

namespace torsion::engine {
namespace {

constexpr ModelPair kDrawnModels{ContactModel::kPatch, BodyModel::kNone, 16};

/// m: of the box around it, ascending.
std::array<double, 3> sides_of(const DrawMesh& mesh) {
  const glm::dvec3 size = box_of(mesh.positions).size();
  std::array<double, 3> sides = {size.x, size.y, size.z};
  std::ranges::sort(sides);
  return sides;
}

/// A page has many runs: their meshes are coarse where nothing is touched.
/// @pre the top of the body is at its frame's origin, and there it is touched
void make_coarse(SceneDescription& scene) {
  constexpr double kFineShare = 0.25;  // of the middle side
  constexpr double kBodyCells = 8.0;   // across it
  constexpr double kToolCells = 18.0;
  DrawMesh& body = scene.bodies[0].draw;
  const std::array<double, 3> sides = sides_of(body);
  body = coarse_mesh(body, glm::vec3(0.0F), static_cast<float>(kFineShare * sides[1]),
                     static_cast<float>(std::sqrt(sides[1] * sides[2]) / kBodyCells));
  DrawMesh& tool = scene.tools[0].draw;
  tool =
      coarse_mesh(tool, glm::vec3(0.0F), 0.0F, static_cast<float>(sides_of(tool)[2] / kToolCells));
}

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

Result<std::string> scene_run(const ReferenceCase& reference_case) {
  constexpr std::size_t kMostMoments = 16;
  Result<Simulation> prepared = prepare_case(reference_case, kDrawnModels);
  if (!prepared) {
    return prepared.error();
  }
  Session session{reference_case.scene, std::move(prepared).value(), {}};
  make_coarse(session.scene);
  Simulation& simulation = session.simulation;
  DeformedRun run(session);
  const std::size_t points = reference_case.path.size();
  const std::size_t every = (points + kMostMoments - 1) / kMostMoments;
  for (std::size_t point = 0; point < points; ++point) {
    move_case(simulation, reference_case, point);
    if (point % every == 0 || point + 1 == points) {
      run.add(session, simulation.world.state.clock.time);
    }
  }
  return run_page_data(session, run);
}

}  // namespace torsion::engine
