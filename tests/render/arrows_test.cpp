#include "render/arrows.hpp"

#include <array>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <gtest/gtest.h>

#include "tests/render/render_scenes.hpp"

namespace torsion::engine {
namespace {

constexpr glm::vec3 kColor(0.1F, 0.2F, 0.3F);

/// Of what the triangles enclose, by the divergence theorem [m^3]; the shaft, which ends open on
/// the tip, leaves out a part of itself.
double volume(const ArrowMesh& mesh) {
  double sum = 0.0;
  for (std::size_t i = 0; i + 2 < mesh.positions.size(); i += 3) {
    sum += glm::dot(glm::dvec3(mesh.positions[i]), glm::cross(glm::dvec3(mesh.positions[i + 1]),
                                                              glm::dvec3(mesh.positions[i + 2]))) /
           6.0;
  }
  return sum;
}

/// The farthest that the mesh goes along `direction`, m.
double reach(const ArrowMesh& mesh, const glm::dvec3& direction) {
  double farthest = -1e300;
  for (const glm::vec4& position : mesh.positions) {
    farthest = std::max(farthest, glm::dot(glm::dvec3(position), direction));
  }
  return farthest;
}

Snapshot wrench_on_one_tool(const glm::dvec3& force, const glm::dvec3& torque) {
  Snapshot snapshot = make_snapshot(1, 0);
  snapshot.tools.at<ToolMotion>(0).mass_center = glm::dvec3(0.1, 0.2, 0.3);
  snapshot.tools.at<ToolWrench>(0).total = {force, torque};
  return snapshot;
}

TEST(ArrowsTest, StraightArrowEndsAtItsTip) {
  ArrowMesh mesh;
  const glm::dvec3 tail(0.1, -0.2, 0.05);
  const glm::dvec3 vector(0.03, 0.04, 0.12);  // 0.13 long
  append_arrow(tail, vector, 0.1, kColor, mesh);
  const glm::dvec3 along = vector / 0.13;
  EXPECT_NEAR(reach(mesh, along), glm::dot(tail, along) + 0.13, 1e-7);
  EXPECT_NEAR(-reach(mesh, -along), glm::dot(tail, along), 1e-7);
}

TEST(ArrowsTest, TrianglesFaceOutwardLikeTheirNormals) {
  for (const double length : {0.005, 0.02, 0.3}) {
    ArrowMesh mesh;
    append_arrow(glm::dvec3(0.0), glm::dvec3(length, 0.0, 0.0), 0.1, kColor, mesh);
    EXPECT_GT(volume(mesh), 0.0) << length;
    for (std::size_t i = 0; i < mesh.positions.size(); i += 3) {
      const glm::dvec3 a(mesh.positions[i]);
      const glm::dvec3 face =
          glm::cross(glm::dvec3(mesh.positions[i + 1]) - a, glm::dvec3(mesh.positions[i + 2]) - a);
      EXPECT_GT(glm::dot(face, glm::dvec3(mesh.normals[i])), 0.0) << i;
    }
  }
}

TEST(ArrowsTest, RowsAreParallelAndNormalsUnit) {
  ArrowMesh mesh;
  append_arrow(glm::dvec3(0.0), glm::dvec3(0.1, 0.1, 0.0), 0.1, kColor, mesh);
  append_arc({glm::dvec3(0.0), glm::dvec3(0.0, 1.0, 0.0), glm::dvec3(1.0, 0.0, 0.0), 0.05}, 2.0,
             0.1, kColor, mesh);
  EXPECT_EQ(mesh.positions.size(), mesh.normals.size());
  EXPECT_EQ(mesh.positions.size(), mesh.colors.size());
  EXPECT_EQ(mesh.positions.size() % 3, 0U);
  for (const glm::vec4& normal : mesh.normals) {
    EXPECT_NEAR(glm::length(glm::vec3(normal)), 1.0F, 1e-6F);
  }
}

TEST(ArrowsTest, NothingIsDrawnForNothing) {
  ArrowMesh mesh;
  append_arrow(glm::dvec3(0.0), glm::dvec3(0.0), 0.1, kColor, mesh);
  append_arrow(glm::dvec3(0.0), glm::dvec3(NAN, 0.0, 0.0), 0.1, kColor, mesh);
  append_arc({glm::dvec3(0.0), glm::dvec3(0.0, 1.0, 0.0), glm::dvec3(1.0, 0.0, 0.0), 0.05}, 0.0,
             0.1, kColor, mesh);
  EXPECT_TRUE(mesh.positions.empty());
}

TEST(ArrowsTest, ArcGoesRightHandedAndEndsAtItsAngle) {
  ArrowMesh mesh;
  const Circle circle{glm::dvec3(0.0), glm::dvec3(0.0, 0.0, 1.0), glm::dvec3(1.0, 0.0, 0.0), 1.0};
  append_arc(circle, 1.2, 0.2, kColor, mesh);
  // The tip is the only corner of its cone with no other at its place: look for the largest angle.
  double last = -10.0;
  for (const glm::vec4& position : mesh.positions) {
    last = std::max(last,
                    std::atan2(static_cast<double>(position.y), static_cast<double>(position.x)));
  }
  // The tip is straight, 0.052 long at size 0.2: it spans its arc to (0.052)^3/24 rad and float.
  EXPECT_NEAR(last, 1.2, 1e-5);
}

TEST(ArrowsTest, GapOfAFullArcFacesTheEye) {
  const std::array radii = {0.05};
  for (const glm::dvec3& torque : {glm::dvec3(0.0, 2.0, 0.0), glm::dvec3(0.0, -2.0, 0.0)}) {
    const Snapshot snapshot = wrench_on_one_tool(glm::dvec3(0.0), torque);
    const glm::dvec3& center = snapshot.tools.at<ToolMotion>(0).mass_center;
    const glm::dvec3 to_eye(0.6, 0.7, -0.8);
    ArrowMesh mesh;
    append_wrenches(snapshot, {0.06, 1.0, 2.0, center + to_eye, radii}, mesh);
    ASSERT_FALSE(mesh.positions.empty());
    for (const glm::vec4& position : mesh.positions) {
      const glm::dvec3 out = glm::dvec3(position) - center;
      const double cosine =
          (out.x * to_eye.x + out.z * to_eye.z) / std::hypot(out.x, out.z);  // to_eye.xz is unit
      // The gap is 60 degrees wide; the tip's foot, 0.1 * 0.06 in radius, stays outside of it.
      EXPECT_LT(cosine, std::cos(glm::radians(29.0)));
    }
  }
}

TEST(ArrowsTest, FullForceIsAsLongAsTheScaleSays) {
  const std::array radii = {0.05};
  const Snapshot snapshot = wrench_on_one_tool(glm::dvec3(0.0, 4.0, 0.0), glm::dvec3(0.0));
  ArrowMesh mesh;
  append_wrenches(snapshot, {0.06, 8.0, 1.0, glm::dvec3(1.0), radii}, mesh);
  EXPECT_NEAR(reach(mesh, glm::dvec3(0.0, 1.0, 0.0)), 0.2 + 0.03, 1e-7);
}

TEST(ArrowsTest, PartsOfTheTorqueAreTheCouplesAndTheRest) {
  const std::array radii = {0.05};
  // A body turned so that its y axis is the world's z. Two contacts with couples of +0.3 and
  // -0.1 N m about it, and 0.5 N m in all.
  const std::array bodies = {
      Pose{{1.0, 2.0, 3.0}, glm::angleAxis(glm::half_pi<double>(), glm::dvec3(1.0, 0.0, 0.0))}};
  Snapshot snapshot = wrench_on_one_tool(glm::dvec3(0.0), glm::dvec3(0.0, 0.0, 0.5));
  snapshot.regions.reserve(2);
  for (const double couple : {0.3, -0.1}) {
    const std::uint32_t row = snapshot.regions.size();
    snapshot.regions.append();
    snapshot.regions.at<RegionFrame>(row).normal = {0.0, 1.0, 0.0};
    snapshot.regions.at<RegionFriction>(row).couple = couple;
    snapshot.regions.at<Contact>(row).radius = 0.02;
    snapshot.regions.at<Contact>(row).equivalent_point = {0.1 * row, 0.0, 0.0};
  }
  // What an arc of this torque alone looks like.
  const auto arc = [&](const glm::dvec3& center, const glm::dvec3& torque, double radius) {
    Snapshot alone = wrench_on_one_tool(glm::dvec3(0.0), torque);
    alone.tools.at<ToolMotion>(0).mass_center = center;
    const std::array one = {radius};
    ArrowMesh mesh;
    append_wrenches(alone, {0.06, 1.0, 1.0, glm::dvec3(9.0), one}, mesh);
    return mesh;
  };
  const glm::dvec3 up(0.0, 0.0, 1.0);
  ArrowMesh expected;
  for (const ArrowMesh& part :
       {arc({1.0, 2.0, 3.0}, 0.3 / 0.5 * up, 0.027), arc({1.1, 2.0, 3.0}, -0.1 / 0.5 * up, 0.027),
        arc(snapshot.tools.at<ToolMotion>(0).mass_center, 0.3 * up, 0.05)}) {
    expected.positions.insert(expected.positions.end(), part.positions.begin(),
                              part.positions.end());
  }
  ArrowMesh mesh;
  append_wrenches(snapshot, {0.06, 1.0, 1.0, glm::dvec3(9.0), radii, true, 0.5, bodies}, mesh);
  ASSERT_EQ(mesh.positions.size(), expected.positions.size());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    EXPECT_LT(glm::length(mesh.positions[i] - expected.positions[i]), 1e-6F) << i;
  }
  // The couples have a colour of their own.
  EXPECT_NE(mesh.colors.front(), mesh.colors.back());
}

TEST(ArrowsTest, NoiseOfATorqueFillsNoScale) {
  // A normal force of 3 N on a contact of 20 mm, and 3e-6 N m: a part in 20 000 of what friction
  // could hold.
  Snapshot snapshot = wrench_on_one_tool(glm::dvec3(0.0, 3.0, 0.0), glm::dvec3(0.0, 3e-6, 0.0));
  snapshot.regions.reserve(1);
  snapshot.regions.append();
  snapshot.regions.at<Contact>(0).radius = 0.02;
  snapshot.regions.at<RegionFriction>(0).couple = 3e-6;
  ArrowLimits limits;
  widen(limits, snapshot.tools, snapshot.regions);
  EXPECT_EQ(limits.force, 3.0);
  for (const double full : {limits.torque, limits.couple}) {
    EXPECT_GT(full, 100.0 * 3e-6);
    // And what slides with a friction of 0.05 shows: 3 pi / 16 mu F a.
    EXPECT_LT(full, 3.0 * glm::pi<double>() / 16.0 * 0.05 * 3.0 * 0.02);
  }
}

}  // namespace
}  // namespace torsion::engine
