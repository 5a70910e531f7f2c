#include "tests/app/run_digest.hpp"

#define XXH_INLINE_ALL
#include <span>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <xxhash.h>

#include "app/session.hpp"
#include "ecs/model_names.hpp"
#include "tests/app/held_loop.hpp"
#include "tests/support/paths.hpp"

namespace torsion::engine::test {
namespace {

constexpr const char* kPinnedScenes[] = {
    "ball_on_cube.gltf",         "ball_on_cube_soft.gltf",         "ball_on_cube_sticky.gltf",
    "compass_on_ellipsoid.gltf", "compass_on_ellipsoid_soft.gltf", "many_regions.gltf",
    "mallet_on_ellipsoid.gltf",  "mallet_on_ellipsoid_soft.gltf",  "two_bodies.gltf",
    "blender/knob_on_pad.glb"};
constexpr double kHeldSeconds = 0.3;  // after half a second's way to where it presses hardest

std::uint64_t digest_of_animation(const PinnedRun& run) {
  PrepareOptions options;
  options.contact_model = run.contact;
  options.body_model = run.body;
  Result<Session> opened = open_session(source_folder() + "/scenes/" + run.scene, options, true);
  EXPECT_TRUE(opened) << opened.error().text;
  Session& session = opened.value();
  RunDigest digest;
  const std::uint64_t steps = steps_in(session, session.scene.duration);
  for (std::uint64_t i = 0; i < steps; ++i) {
    step_scripted(session);
    digest.add(session.simulation.world);
  }
  return digest.value();
}

std::uint64_t digest_of_hold(const PinnedRun& run) {
  const HeldScene scene{run.scene, run.contact, run.body};
  RunDigest digest;
  hold(scene, HandTraits{}, hardest(scene), kHeldSeconds,
       [&digest](const World& world) { digest.add(world); });
  return digest.value();
}

}  // namespace

void RunDigest::add(const World& world) {
  row_.clear();
  const auto add_vector = [this](const glm::dvec3& vector) {
    row_.insert(row_.end(), {vector.x, vector.y, vector.z});
  };
  for (std::uint32_t tool = 0; tool < world.model.tools.size(); ++tool) {
    const Pose& pose = world.state.tools.at<ToolPose>(tool).now;
    const ToolWrench& wrench = world.state.tools.at<ToolWrench>(tool);
    add_vector(pose.position);
    row_.insert(row_.end(), {pose.rotation.x, pose.rotation.y, pose.rotation.z, pose.rotation.w});
    add_vector(wrench.total.force);
    add_vector(wrench.total.torque);
    row_.push_back(wrench.work);
  }
  for (std::uint32_t region = 0; region < world.state.regions.size(); ++region) {
    const RegionIdentity& identity = world.state.regions.at<RegionIdentity>(region);
    const RegionWrench& wrench = world.state.regions.at<RegionWrench>(region);
    row_.insert(row_.end(),
                {static_cast<double>(identity.order), static_cast<double>(identity.body),
                 static_cast<double>(identity.tool)});
    add_vector(world.state.regions.at<Contact>(region).equivalent_point);
    add_vector(wrench.on_tool.force);
    add_vector(wrench.on_tool.torque);
  }
  row_.push_back(static_cast<double>(world.state.clock.faults));
  const auto bytes = std::as_bytes(std::span(row_));
  value_ = XXH3_64bits_withSeed(bytes.data(), bytes.size(), value_);
}

std::string name_of(const PinnedRun& run) {
  return fmt::format("{} {} {} {}", run.scene, run.held ? "held" : "animation",
                     name_of(run.contact), name_of(run.body));
}

std::vector<PinnedRun> pinned_runs() {
  std::vector<PinnedRun> runs;
  for (const char* const scene : kPinnedScenes) {
    for (const ContactModel contact :
         {ContactModel::kPaper, ContactModel::kMdr, ContactModel::kPatch}) {
      for (const BodyModel body :
           {BodyModel::kNone, BodyModel::kSkeleton, BodyModel::kCompliance}) {
        runs.push_back({scene, contact, body});
      }
    }
    runs.push_back({scene, ContactModel::kAuto, BodyModel::kAuto, true});
  }
  return runs;
}

std::uint64_t digest_of(const PinnedRun& run) {
  return run.held ? digest_of_hold(run) : digest_of_animation(run);
}

std::string instruction_set() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0) {
    return "x86_64_fma";
  }
#endif
  return "other";
}

std::string pinned_line(const PinnedRun& run, std::uint64_t digest) {
  return fmt::format("{} {} {:016x}", instruction_set(), name_of(run), digest);
}

std::string pinned_file() {
  return source_folder() + "/tests/app/pinned_results.txt";
}

}  // namespace torsion::engine::test
