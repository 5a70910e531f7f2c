#pragma once

// What a scene is made of: elastic bodies, which are fixed somewhere, and rigid tools that press on
// them. Plain data; any thread may use a scene of its own.

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "torsion/types.hpp"

namespace torsion {

enum class Shape { kBox, kSphere, kEllipsoid, kCylinder, kCapsule, kMesh };

/// One closed solid; a body or tool is the union of its parts.
struct Part {
  Shape shape = Shape::kSphere;
  Vector3 size{};  // m: full extents along the part's x, y and z; nothing for a mesh. The axis of a
                   // cylinder or capsule is y; a capsule's extent along y includes its caps.
  Pose pose;       // in the frame of the body or tool
  Mesh mesh;       // of Shape::kMesh: closed, in the part's frame
};

TORSION_API Part make_box(const Vector3& size, const Pose& pose = {});
TORSION_API Part make_sphere(double radius, const Pose& pose = {});
TORSION_API Part make_ellipsoid(const Vector3& size, const Pose& pose = {});
TORSION_API Part make_cylinder(double radius, double height, const Pose& pose = {});
TORSION_API Part make_capsule(double radius, double height, const Pose& pose = {});
TORSION_API Part make_mesh(Mesh mesh, const Pose& pose = {});

/// Linear elastic and isotropic, with Coulomb friction against every tool.
struct Material {
  double youngs_modulus = 3e6;  // Pa, above 0
  double poisson_ratio = 0.5;   // 0 to 0.5
  double density = 1100.0;      // kg/m^3, above 0
  double static_friction = 0.75;
  double dynamic_friction = 0.75;  // 0 to static_friction
};

/// What holds a body.
enum class Fixed {
  kAsInFile,      // for a body that a file describes
  kBottomCenter,  // a point: the middle of the lowest face of the bounding box, along `up`
  kBottomFace,    // all of the surface at the lowest height along `up`
  kPoint,         // Body::fixed_point
  kVolumes,       // what lies in Body::fixed_volumes
};

struct FixedVolume {
  enum class Kind { kBox, kSphere };
  Kind kind = Kind::kBox;
  Vector3 size{};  // m: full extents
  Pose pose;       // in the body's frame
};

inline constexpr std::size_t kNotInFile = static_cast<std::size_t>(-1);

struct Body {
  std::string name;
  Pose pose;                // the body's frame in the world
  std::vector<Part> parts;  // none: as in the file that the scene was loaded from
  Material material;
  Fixed fixed = Fixed::kBottomCenter;
  Vector3 up{0.0, 1.0, 0.0};  // world, unit: for the two kinds of bottom
  Vector3 fixed_point{};      // m, body
  std::vector<FixedVolume> fixed_volumes;
  std::string contact_model = "auto";  // auto, paper, mdr, patch or winkler
  std::string body_model = "auto";     // auto, none, skeleton or compliance
  double tolerance = 0.05;             // relative error of the torque that auto may choose
  double region_threshold = 0.0;       // m: contacts nearer than this are one region; 0: as sampled
  std::size_t file_row = kNotInFile;   // of the body in the scene's file
};

struct Tool {
  std::string name;
  std::vector<Part> parts;             // none: as in the file
  double mass = 1.0;                   // kg
  std::optional<Vector3> mass_center;  // m, tool; none: the centroid of the parts
  std::size_t file_row = kNotInFile;   // of the tool in the scene's file
};

struct SceneFile;  // what a glTF file holds besides; not for users

struct Scene {
  std::vector<Body> bodies;
  std::vector<Tool> tools;
  std::string path;                       // of the file; empty for a scene that was made by code
  double duration = 0.0;                  // s: the end of the file's animations
  std::shared_ptr<const SceneFile> file;  // null for a scene that was made by code

  /// The first body or tool of that name, or null.
  TORSION_API Body* body(std::string_view name) noexcept;
  TORSION_API Tool* tool(std::string_view name) noexcept;
};

/// Reads a .gltf or .glb by the conventions of docs/scenes.md. The error lists everything that is
/// wrong with the file, one a line, as `torsion check` does. Everything of its bodies and tools may
/// be changed afterwards; shapes by giving them parts.
TORSION_API Result<Scene> load_scene(const std::string& path);

/// Where the file's animation holds a tool at `time` [s]; the identity for a scene without a file.
/// @pre tool < scene.tools.size()
TORSION_API Pose animated_pose(const Scene& scene, std::size_t tool, double time);

}  // namespace torsion
