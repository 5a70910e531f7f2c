// The window's parts that need no window: camera, drag, history, the watch over a scene's files.

#include <cmath>
#include <filesystem>
#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "app/round_up.hpp"
#include "app/view/gallery.hpp"
#include "app/view/history.hpp"
#include "app/view/orbit_camera.hpp"
#include "app/view/panel_layout.hpp"
#include "app/view/plots.hpp"
#include "app/view/recent_scenes.hpp"
#include "app/view/region_history.hpp"
#include "app/view/scene_watch.hpp"
#include "app/view/tool_drag.hpp"
#include "render/image_io.hpp"
#include "tests/app/program.hpp"
#include "tests/support/paths.hpp"

namespace torsion::engine {
namespace {

constexpr glm::dvec2 kPicture(1280.0, 720.0);

TEST(OrbitCameraTest, StandsWhereTheCameraStoodAndLooksTheSameWay) {
  Camera camera;
  camera.pose.position = {0.3, 0.4, 0.5};
  camera.pose.rotation = glm::angleAxis(0.6, glm::dvec3(0.0, 1.0, 0.0)) *
                         glm::angleAxis(-0.5, glm::dvec3(1.0, 0.0, 0.0));
  const Camera again = camera_of(orbit_of(camera, glm::dvec3(0.0)));
  EXPECT_LT(glm::length(again.pose.position - camera.pose.position), 1e-12);
  EXPECT_NEAR(std::abs(glm::dot(again.pose.rotation, camera.pose.rotation)), 1.0, 1e-12);
}

TEST(OrbitCameraTest, TurningKeepsTheDistanceAndUpIsUp) {
  OrbitCamera camera;
  camera.target = {0.1, 0.0, 0.0};
  camera.distance = 0.7;
  for (int i = 0; i < 50; ++i) {
    orbit(camera, {0.3, 0.2});
    const Pose pose = camera_of(camera).pose;
    EXPECT_NEAR(glm::length(pose.position - camera.target), 0.7, 1e-12);
    EXPECT_GT((pose.rotation * glm::dvec3(0.0, 1.0, 0.0)).y, 0.0);
    const glm::dvec3 seen = seen_at(camera_of(camera), camera.target, kPicture);
    EXPECT_NEAR(seen.x, 640.0, 1e-6);
    EXPECT_NEAR(seen.y, 360.0, 1e-6);
  }
}

TEST(OrbitCameraTest, PanningMovesWhatIsAtTheTargetWithTheMouse) {
  OrbitCamera camera;
  camera.azimuth = 0.7;
  camera.elevation = 0.3;
  const glm::dvec3 point = camera.target;
  pan(camera, {25.0, -40.0}, kPicture.y);
  const glm::dvec3 seen = seen_at(camera_of(camera), point, kPicture);
  EXPECT_NEAR(seen.x, 640.0 + 25.0, 1e-9);
  EXPECT_NEAR(seen.y, 360.0 - 40.0, 1e-9);
}

TEST(OrbitCameraTest, ARayGoesThroughWhatIsSeenAtItsPixel) {
  OrbitCamera orbiting;
  orbiting.azimuth = 2.0;
  const Camera camera = camera_of(orbiting);
  const PixelRay ray = ray_through(camera, {200.0, 500.0}, kPicture);
  const glm::dvec3 seen = seen_at(camera, ray.origin + 0.8 * ray.direction, kPicture);
  EXPECT_NEAR(seen.x, 200.0, 1e-9);
  EXPECT_NEAR(seen.y, 500.0, 1e-9);
}

TEST(OrbitCameraTest, AShiftedPictureIsTheSameForTheShadersAndForTheMouse) {
  OrbitCamera orbiting;
  orbiting.azimuth = 0.3;
  orbiting.elevation = 0.5;
  Camera camera = camera_of(orbiting);
  camera.shift = 0.125;
  // A panel covers a quarter on the left: the middle of the rest is at 5/8.
  EXPECT_NEAR(seen_at(camera, orbiting.target, kPicture).x, 0.625 * kPicture.x, 1e-9);
  const glm::dvec3 point(0.05, 0.1, -0.02);
  const glm::dvec3 seen = seen_at(camera, point, kPicture);
  const glm::dvec4 clip = projection_matrix(camera, kPicture.x / kPicture.y) * view_matrix(camera) *
                          glm::dvec4(point, 1.0);
  EXPECT_NEAR(seen.x, (0.5 + 0.5 * clip.x / clip.w) * kPicture.x, 1e-9);
  EXPECT_NEAR(seen.y, (0.5 + 0.5 * clip.y / clip.w) * kPicture.y, 1e-9);
  const PixelRay ray = ray_through(camera, {seen.x, seen.y}, kPicture);
  EXPECT_LT(glm::length(glm::cross(ray.direction, glm::normalize(point - ray.origin))), 1e-12);
}

TEST(PanelLayoutTest, TakesAQuarterAndFoldsInSmallWindows) {
  ViewState state;
  EXPECT_LE(covered_columns(state, 1280.0F, 720.0F), 0.25F * 1280.0F);
  EXPECT_LE(covered_columns(state, 1920.0F, 1080.0F), 0.25F * 1920.0F);
  EXPECT_TRUE(folded(state, 700.0F, 500.0F));
  EXPECT_LE(covered_columns(state, 700.0F, 500.0F), 0.1F * 700.0F);
  state.folded = false;  // a person wants it
  EXPECT_FALSE(folded(state, 700.0F, 500.0F));
  state.show_panels = false;
  EXPECT_EQ(covered_columns(state, 1280.0F, 720.0F), 0.0F);
}

TEST(ToolDragTest, ARayMeetsATurnedBoxWhereItDoes) {
  const Bounds bounds{{-1.0, -2.0, -3.0}, {1.0, 2.0, 3.0}};
  // Turned a quarter about y the box is 3 deep towards x.
  const Pose pose{{10.0, 0.0, 0.0},
                  glm::angleAxis(std::numbers::pi / 2.0, glm::dvec3(0.0, 1.0, 0.0))};
  const auto met = meets_box({{0.0, 0.5, 0.0}, {1.0, 0.0, 0.0}, 0.0}, pose, bounds);
  ASSERT_TRUE(met.has_value());
  EXPECT_NEAR(*met, 7.0, 1e-12);
  EXPECT_FALSE(meets_box({{0.0, 2.5, 0.0}, {1.0, 0.0, 0.0}, 0.0}, pose, bounds));
  EXPECT_FALSE(meets_box({{0.0, 0.0, 0.0}, {-1.0, 0.0, 0.0}, 0.0}, pose, bounds));
}

TEST(ToolDragTest, WhatWasTakenStaysUnderTheMouse) {
  OrbitCamera orbiting;
  orbiting.azimuth = 0.4;
  orbiting.elevation = 0.6;
  const Camera camera = camera_of(orbiting);
  Pose handle{{0.05, 0.02, 0.1}, glm::dquat(1.0, 0.0, 0.0, 0.0)};
  const glm::dvec3 before = seen_at(camera, handle.position, kPicture);
  ToolDrag taken{0, before.z, {before.x, before.y}};
  drag(taken, DragKind::kAcross, {before.x + 30.0, before.y - 12.0}, camera, kPicture.y, {}, {},
       handle);
  const glm::dvec3 after = seen_at(camera, handle.position, kPicture);
  EXPECT_NEAR(after.x, before.x + 30.0, 1e-9);
  EXPECT_NEAR(after.y, before.y - 12.0, 1e-9);
  EXPECT_NEAR(after.z, before.z, 1e-12);
}

Camera camera_from_above(double elevation) {
  OrbitCamera orbiting;
  orbiting.azimuth = 0.4;
  orbiting.elevation = elevation;
  return camera_of(orbiting);
}

TEST(ToolDragTest, PressingFollowsTheAxisOnTheScreenAndNothingElse) {
  const Camera camera = camera_from_above(0.6);
  const glm::dvec3 axis(0.0, 1.0, 0.0);
  // Straight below the middle of the picture, where the axis is seen upright.
  Pose handle{{0.0, 0.02, 0.0}, glm::dquat(1.0, 0.0, 0.0, 0.0)};
  const glm::dvec3 start = handle.position;
  const glm::dvec3 before = seen_at(camera, start, kPicture);
  ToolDrag taken{0, before.z, {before.x, before.y}};
  // 20 pixels down where the axis points up on the screen; sideways says nothing.
  drag(taken, DragKind::kPress, {before.x + 50.0, before.y + 20.0}, camera, kPicture.y, start, axis,
       handle);
  EXPECT_EQ(handle.position.x, start.x);
  EXPECT_EQ(handle.position.z, start.z);
  EXPECT_LT(handle.position.y, start.y);
  // Straight on the screen but for perspective: on its way the handle comes nearer by this share of
  // its distance.
  const double nearer =
      20.0 / kPicture.y * 2.0 * std::tan(camera.vertical_field_of_view / 2.0) * std::tan(0.6);
  EXPECT_NEAR(seen_at(camera, handle.position, kPicture).y, before.y + 20.0, 1.5 * 20.0 * nearer);
}

// It goes round at the speed asked for, spins about its own contact, and is back after one way
// round.
TEST(ToolDragTest, ADriveSlidesRoundAndSpins) {
  const glm::dvec3 axis = glm::normalize(glm::dvec3(0.2, 1.0, -0.1));
  const glm::dvec3 tangent = glm::normalize(glm::cross(axis, glm::dvec3(0.0, 0.0, 1.0)));
  ToolDrive drive{0,
                  {{0.1, 0.2, 0.3}, glm::dquat(1.0, 0.0, 0.0, 0.0)},
                  {0.1, 0.17, 0.3},
                  axis,
                  tangent,
                  5e-3,
                  0.0,
                  0.0,
                  2.0};
  const double around = 2.0 * std::numbers::pi * 5e-3;  // m
  constexpr double kSlide = 0.01;                       // m/s
  constexpr double kStep = 1e-3;                        // s
  Pose before = drive_on(drive, 0.0, 0.0, 2.0);
  EXPECT_EQ(before.position, drive.start.position);
  double time = 2.0;
  double way = 0.0;
  for (; time < 2.0 + around / kSlide; time += kStep) {
    const Pose now = drive_on(drive, kSlide, 0.0, time + kStep);
    const glm::dvec3 step = now.position - before.position;
    EXPECT_NEAR(glm::length(step), kSlide * kStep, 1e-7 * kSlide);
    EXPECT_NEAR(glm::dot(step, axis), 0.0, 1e-15);
    way += glm::length(step);
    before = now;
  }
  EXPECT_NEAR(glm::length(before.position - drive.start.position), 0.0, 2.0 * kSlide * kStep);
  EXPECT_EQ(before.rotation, drive.start.rotation);
  // Spinning only: about the contact's axis.
  ToolDrive spin = drive;
  spin.way = 0.0;
  const Pose turned = drive_on(spin, 0.0, 0.5, spin.time + 1.0);
  EXPECT_NEAR(glm::angle(turned.rotation), 0.5, 1e-12);
  EXPECT_NEAR(glm::length(turned.position - spin.pivot),
              glm::length(spin.start.position - spin.pivot), 1e-15);
  // A restart sets the time back: it stays where it is.
  EXPECT_EQ(drive_on(spin, 1.0, 1.0, 0.0).position, turned.position);
}

TEST(ToolDragTest, PressingFromStraightAboveTakesTheMousesWayDown) {
  const Camera camera = camera_from_above(1.55);
  const glm::dvec3 axis(0.0, 1.0, 0.0);
  Pose handle{{0.0, 0.0, 0.0}, glm::dquat(1.0, 0.0, 0.0, 0.0)};
  ToolDrag taken{0, 0.5, {100.0, 100.0}};
  drag(taken, DragKind::kPress, {100.0, 110.0}, camera, kPicture.y, {}, axis, handle);
  const double meters = 10.0 * 2.0 * 0.5 * std::tan(camera.vertical_field_of_view / 2.0) / 720.0;
  EXPECT_NEAR(handle.position.y, -meters, 1e-12);
}

TEST(ToolDragTest, SlidingStaysOnTheSurface) {
  const Camera camera = camera_from_above(0.6);
  const glm::dvec3 axis = glm::normalize(glm::dvec3(0.3, 1.0, -0.2));
  Pose handle{{0.05, 0.02, 0.1}, glm::dquat(1.0, 0.0, 0.0, 0.0)};
  const glm::dvec3 start = handle.position;
  ToolDrag taken{0, 0.5, {100.0, 100.0}};
  drag(taken, DragKind::kSlide, {140.0, 80.0}, camera, kPicture.y, start, axis, handle);
  EXPECT_NEAR(glm::dot(handle.position - start, axis), 0.0, 1e-12);
  EXPECT_GT(glm::length(handle.position - start), 0.005);
}

TEST(ToolDragTest, ATurnKeepsWhatIsOnTheAxis) {
  Pose handle{{0.1, 0.3, 0.0}, glm::dquat(1.0, 0.0, 0.0, 0.0)};
  const glm::dvec3 pivot(0.1, 0.0, 0.0);
  turn(handle, pivot, {0.0, 1.0, 0.0}, 0.5);
  EXPECT_LT(glm::length(handle.position - glm::dvec3(0.1, 0.3, 0.0)), 1e-12);
  EXPECT_NEAR(glm::angle(handle.rotation), 0.5, 1e-12);
}

LiveRow row_at(double time, double step_us, std::uint64_t generation = 0) {
  LiveRow row;
  row.trace.time = time;
  row.trace.step_us = step_us;
  row.generation = generation;
  return row;
}

TEST(HistoryTest, ThinsButKeepsTheLongestStep) {
  History history;
  for (int i = 0; i < 9; ++i) {
    history.add(row_at(1e-3 * i, i == 2 ? 900.0 : 10.0));
  }
  ASSERT_EQ(history.size(), 3U);
  EXPECT_EQ(history[0].step_us, 10.0);
  EXPECT_EQ(history[1].step_us, 900.0);
  EXPECT_EQ(history[2].step_us, 10.0);
}

TEST(HistoryTest, ForgetsTheOldestAndARestartForgetsAll) {
  History history;
  for (std::size_t i = 0; i < History::kPoints + 10; ++i) {
    history.add(row_at(1e-2 * static_cast<double>(i), 1.0));
  }
  EXPECT_EQ(history.size(), History::kPoints);
  EXPECT_NEAR(history[0].time, 0.1, 1e-12);
  history.add(row_at(0.0, 1.0));
  EXPECT_EQ(history.size(), 1U);
}

TEST(HistoryTest, ContactAxesTurnAWrenchWithoutChangingItsSize) {
  const glm::dvec3 normal = glm::normalize(glm::dvec3(1.0, 2.0, -1.0));
  const glm::dvec3 tangent = glm::normalize(glm::cross(normal, glm::dvec3(0.0, 0.0, 1.0)));
  const Wrench world{3.0 * normal + 0.5 * tangent, -2.0 * normal};
  const Wrench contact = in_contact_axes(world, normal, tangent);
  EXPECT_NEAR(contact.force.z, 3.0, 1e-12);
  EXPECT_NEAR(contact.force.x, 0.5, 1e-12);
  EXPECT_NEAR(contact.force.y, 0.0, 1e-12);
  EXPECT_NEAR(contact.torque.z, -2.0, 1e-12);
}

Snapshot with_regions(double time, const std::vector<std::uint64_t>& orders) {
  Snapshot snapshot;
  snapshot.clock.time = time;
  snapshot.regions.reserve(16);
  for (const std::uint64_t order : orders) {
    const std::uint32_t row = snapshot.regions.size();
    snapshot.regions.append();
    snapshot.regions.at<RegionIdentity>(row).tool = static_cast<std::uint32_t>(order % 2);
    snapshot.regions.at<RegionIdentity>(row).order = order;
    snapshot.regions.at<RegionNormal>(row).force = static_cast<double>(order);
  }
  return snapshot;
}

TEST(RegionHistoryTest, KeepsTheRegionsOfItsToolApart) {
  RegionHistory history;
  history.add(with_regions(0.0, {2, 3, 4}), 0);
  history.add(with_regions(0.001, {2, 3, 4}), 0);  // too soon
  history.add(with_regions(0.02, {4, 5, 6, 8}), 0);
  ASSERT_EQ(history.size(), 2U);
  ASSERT_EQ(history[0].count, 2U);
  EXPECT_EQ(history[0].regions[1].order, 4U);
  EXPECT_EQ(history[0].regions[1].normal_force, 4.0);
  ASSERT_EQ(history[1].count, 3U);
  EXPECT_EQ(history[1].regions[0].order, 4U);
  history.add(with_regions(0.0, {}), 0);  // from the start
  ASSERT_EQ(history.size(), 1U);
  EXPECT_EQ(history[0].count, 0U);
}

TEST(RegionHistoryTest, ForgetsTheOldestAndTakesNoMoreThanItHolds) {
  RegionHistory history;
  for (std::size_t i = 0; i < RegionHistory::kMoments + 3; ++i) {
    history.add(with_regions(0.1 * static_cast<double>(i), {}), 0);
  }
  EXPECT_EQ(history.size(), RegionHistory::kMoments);
  EXPECT_NEAR(history[0].time, 0.3, 1e-12);
  history.add(with_regions(1e6, {2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24}), 0);
  EXPECT_EQ(history[history.size() - 1].count, RegionHistory::kMost);
}

TEST(PlotsTest, TheMouseReadsTheNearestPointAndNothingWhereACurveIsInterrupted) {
  const Curve curve{"", 0, {-3.0, -2.0, -1.0, 0.0}, {1.0, NAN, 2.0, 3.0}};
  EXPECT_EQ(nearest_in_x(curve, -5.0), 0U);
  EXPECT_EQ(nearest_in_x(curve, -2.6), 0U);
  EXPECT_EQ(nearest_in_x(curve, -2.4), 4U);  // none
  EXPECT_EQ(nearest_in_x(curve, -0.6), 2U);
  EXPECT_EQ(nearest_in_x(curve, 9.0), 3U);
  EXPECT_EQ(nearest_in_x(Curve{}, 0.0), 0U);
}

TEST(PlotsTest, ScalesEndAtRoundNumbers) {
  EXPECT_DOUBLE_EQ(round_up(0.9), 1.0);
  EXPECT_DOUBLE_EQ(round_up(1.1), 2.0);
  EXPECT_DOUBLE_EQ(round_up(0.021), 0.05);
  EXPECT_DOUBLE_EQ(round_up(50.0), 50.0);
  EXPECT_DOUBLE_EQ(round_up(0.0), 1.0);
}

TEST(SceneWatchTest, SaysOnceThatAFileOrItsBufferHasChanged) {
  const test::Folder folder;
  const std::string scene = folder / "a.gltf";
  test::write_text(folder / "a.bin", "1234");
  test::write_text(scene, R"({"buffers": [{"uri": "a.bin", "byteLength": 4}]})");
  SceneWatch watch(scene);
  EXPECT_FALSE(watch.changed());
  EXPECT_FALSE(watch.changing());
  test::write_text(folder / "a.bin", "12345");
  EXPECT_FALSE(watch.changed());  // may still be written to
  EXPECT_TRUE(watch.changing());
  EXPECT_TRUE(watch.changed());
  EXPECT_FALSE(watch.changing());
  EXPECT_FALSE(watch.changed());
  test::write_text(scene, "{}  ");
  EXPECT_FALSE(watch.changed());
  EXPECT_TRUE(watch.changed());
  std::filesystem::remove(scene);  // as some editors do before they write anew
  EXPECT_FALSE(watch.changed());
  EXPECT_TRUE(watch.changed());
}

TEST(GalleryTest, HasTheScenesOfItsFolderThenThoseWithATitle) {
  const test::Folder folder;
  const std::filesystem::path scenes = folder / "share/torsion/scenes";
  std::filesystem::create_directories(scenes / "gallery");
  std::filesystem::create_directories(folder / "bin");
  const auto scene = [](const std::string& extras) {
    return R"({"scene": 1, "scenes": [{}, {"extras": {)" + extras + "}}]}";
  };
  test::write_text(scenes / "gallery" / "2_b.gltf", scene(R"("torsion_title": "B")"));
  test::write_text(scenes / "gallery" / "1_a.gltf", scene(R"("torsion_title": "A")"));
  test::write_text(scenes / "gallery" / "0_bad.gltf", "{");
  test::write_text(scenes / "c.gltf", scene(R"("torsion_title": "C")"));
  test::write_text(scenes / "d.gltf", scene(""));
  test::write_text(scenes / "e.gltf", scene(R"("torsion_title": 5)"));
  test::write_text(scenes / "f.gltf", "[]");
  test::write_text(scenes / "g.gltf", R"({"scene": "x", "scenes": []})");
  EXPECT_EQ(shipped_scenes(folder / "bin/torsion"), scenes);
  const std::vector<GalleryEntry> gallery = read_gallery(scenes);
  ASSERT_EQ(gallery.size(), 3U);
  EXPECT_EQ(gallery[0], (GalleryEntry{scenes / "gallery/1_a.gltf", "A", "", {}}));
  EXPECT_EQ(gallery[1], (GalleryEntry{scenes / "gallery/2_b.gltf", "B", "", {}}));
  EXPECT_EQ(gallery[2], (GalleryEntry{scenes / "c.gltf", "C", "", {}}));
  EXPECT_EQ(entry_of(gallery, scenes / "gallery/../c.gltf"), 2U);
  EXPECT_FALSE(entry_of(gallery, scenes / "d.gltf"));
}

TEST(GalleryTest, HasThePicturesThatFitItsCards) {
  const test::Folder folder;
  const std::filesystem::path scenes(folder / ".");
  std::filesystem::create_directories(scenes / "gallery");
  const auto scene = [](const std::string& name) {
    return R"({"scenes": [{"extras": {"torsion_title": ")" + name +
           R"(", "torsion_caption": "look"}}]})";
  };
  const auto picture = [](std::uint32_t width, std::uint32_t height) {
    return Image{width, height, std::vector<std::uint8_t>(std::size_t{4} * width * height, 200)};
  };
  for (const std::string name : {"a", "b", "c"}) {
    test::write_text(scenes / (name + ".gltf"), scene(name));
  }
  ASSERT_TRUE(write_png(picture(kCardWidth, kCardHeight), scenes / "gallery/a.png"));
  ASSERT_TRUE(write_png(picture(kCardWidth, kCardHeight - 1), scenes / "gallery/b.png"));
  const std::vector<GalleryEntry> gallery = read_gallery(scenes);
  ASSERT_EQ(gallery.size(), 3U);
  EXPECT_EQ(gallery[0].caption, "look");
  EXPECT_EQ(gallery[0].picture, picture(kCardWidth, kCardHeight));
  EXPECT_EQ(gallery[1].picture, Image{});
  EXPECT_EQ(gallery[2].picture, Image{});
}

TEST(RecentScenesTest, KeepsTheLastThreeThatAreStillThere) {
  const test::Folder folder;
  const std::filesystem::path list(folder / "cache/recent_scenes");
  EXPECT_TRUE(recent_scenes(list).empty());
  for (const char* name : {"a.gltf", "b.gltf", "c.gltf", "d.gltf"}) {
    test::write_text(folder / name, "{}");
    remember_scene(list, folder / name);
  }
  remember_scene(list, folder / "c.gltf");          // again
  remember_scene(list, folder / "not there.gltf");  // changes nothing
  const auto names = [&] {
    std::vector<std::string> all;
    for (const std::filesystem::path& scene : recent_scenes(list)) {
      all.push_back(scene.filename().string());
    }
    return all;
  };
  EXPECT_EQ(names(), (std::vector<std::string>{"c.gltf", "d.gltf", "b.gltf"}));
  std::filesystem::remove(folder / "d.gltf");
  EXPECT_EQ(names(), (std::vector<std::string>{"c.gltf", "b.gltf"}));
  // A list that cannot be written is left out.
  test::write_text(folder / "file", "");
  remember_scene(folder / "file/recent_scenes", folder / "a.gltf");
  EXPECT_TRUE(recent_scenes(folder / "file/recent_scenes").empty());
}

TEST(GalleryTest, IsEmptyWhereNothingShips) {
  const test::Folder folder;
  EXPECT_TRUE(read_gallery(folder / "nowhere").empty());
}

TEST(GalleryTest, EveryShippedSceneHasAPictureAndASentence) {
  const std::vector<GalleryEntry> gallery = read_gallery(test::source_folder() + "/scenes");
  EXPECT_EQ(gallery.size(), 14U);
  for (const GalleryEntry& entry : gallery) {
    EXPECT_EQ(entry.picture.width, kCardWidth) << entry.file;
    EXPECT_NE(entry.caption, "") << entry.file;
  }
}

}  // namespace
}  // namespace torsion::engine
