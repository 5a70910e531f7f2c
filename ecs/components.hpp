#pragma once

// Every component of the simulation: one plain struct is one column of one table (ecs/world.hpp
// lists the tables). Units are SI: m, kg, s, N, N m, rad, Pa. A frame is named with every vector:
//   world  the scene's frame, +Y up
//   body   the elastic node's frame without its scale; a body does not move, so this is a fixed
//   shift and turn of world tool   the tool node's frame without its scale grid   a region's
//   tangent frame: x along tangent_x, y along tangent_y, z along the outward normal
// "Written by" names the one system (file systems/NAME.cpp) that writes the column; "load" means it
// is constant.

#include <array>
#include <cstdint>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "ecs/entity.hpp"

namespace torsion {

inline constexpr std::uint32_t kMaxRegionsPerBody =
    16;  // also the number of twist columns a vertex can have
inline constexpr std::uint32_t kNoRow = UINT32_MAX;  // "no row"

// ----------------------------------------------------------------------------------------------
// shared by tables

/// A rigid placement: x_outer = rotation * x_inner + position.
struct Pose {
  glm::dvec3 position{0.0};                 // m, outer frame
  glm::dquat rotation{1.0, 0.0, 0.0, 0.0};  // unit quaternion, inner to outer
};

/// A force and the torque that goes with it; the reference point and the frame are said where it is
/// used.
struct Wrench {
  glm::dvec3 force{0.0};   // N
  glm::dvec3 torque{0.0};  // N m
};

// -------------------------------------------------------------------------------------------------------
// shapes

enum class ShapeKind : std::uint32_t { kSphere, kEllipsoid, kBox, kCylinder, kCapsule, kMesh };

/// One closed solid of a tool or body; a tool or body is the union of its parts. Written by: load.
/// Cylinder and capsule have their axis along y; a capsule's half_extent.y includes its caps.
struct ShapePart {
  Pose pose;                    // part frame in the owner's frame (tool or body)
  glm::dvec3 half_extent{0.0};  // m, part frame; a sphere uses .x
  ShapeKind kind = ShapeKind::kSphere;
  std::uint32_t field = kNoRow;  // row in `fields` when kind is kMesh
};

/// A two-level grid of signed distances to a closed mesh: coarse nodes everywhere, bricks of fine
/// nodes near the surface (systems/distance_field.hpp says how it is read). Written by: load.
struct DistanceField {
  glm::dvec3 origin{0.0};         // m, part frame, the lowest node
  double spacing = 0.0;           // m, between coarse nodes
  glm::uvec3 cells{0};            // coarse cells along each axis; nodes are one more
  std::uint32_t subdivision = 1;  // fine cells along one edge of a coarse cell
  Range coarse_nodes;             // rows in `field_nodes`, x fastest
  Range bricks;                   // rows in `field_bricks`, one for each coarse cell, x fastest
};

/// Gradient and signed distance at one grid node (negative inside). Written by: load.
struct DistanceNode {
  glm::vec4 gradient_and_distance{0.0F};  // xyz: unitless, part frame; w: m
};

/// First row in `field_nodes` of a coarse cell's (subdivision + 1)^3 fine nodes, or kNoRow. Written
/// by: load.
struct DistanceBrick {
  std::uint32_t first_node = kNoRow;
};

/// A node of the sphere tree over a tool's surface: everything of the surface below it lies in this
/// ball. Written by: load.
struct SurfaceBall {
  glm::dvec3 center{0.0};  // m, tool frame
  double radius = 0.0;     // m
  std::uint32_t skip =
      0;  // row, relative to the tool's first ball, to go to when this ball is far away
  std::uint32_t sample =
      kNoRow;  // row, relative to the tool's first sample, for a leaf; kNoRow inside the tree
};

inline constexpr std::uint32_t kSampleNeighbours = 8;

/// A point of a tool's surface. Its neighbours are rows relative to the tool's first sample.
/// Written by: load.
struct SurfaceSample {
  glm::dvec3 position{0.0};                          // m, tool frame
  double spacing = 0.0;                              // m, to the farthest of its neighbours
  std::uint32_t neighbours[kSampleNeighbours] = {};  // kNoRow where there are fewer
};

// -------------------------------------------------------------------------------------------------------
// bodies

/// Linear elastic, isotropic. Written by: load.
struct Elasticity {
  double youngs_modulus = 3e6;  // E, Pa
  double poisson_ratio = 0.5;   // nu
  double density = 1100.0;      // rho, kg/m^3
  [[nodiscard]] double shear_modulus()
      const {  // G = E / (2 (1 + nu)), equation (3) of the paper, Pa
    return youngs_modulus / (2.0 * (1.0 + poisson_ratio));
  }
  [[nodiscard]] double contact_modulus() const {  // E* = E / (1 - nu^2) against a rigid tool, Pa
    return youngs_modulus / (1.0 - poisson_ratio * poisson_ratio);
  }
};

/// Coulomb coefficients, static_friction >= dynamic_friction >= 0. Written by: load.
struct Friction {
  double static_friction = 0.75;
  double dynamic_friction = 0.75;
};

enum class FixedKind : std::uint32_t { kPoint, kFace, kVolumes };

/// What holds the body. Written by: load.
struct FixedRegion {
  FixedKind kind = FixedKind::kPoint;
  std::uint32_t padding = 0;
  glm::dvec3 point{
      0.0};  // m, body: q_f of the paper; the centroid of a face or of the fixed volumes
  glm::dvec3 normal{0.0};  // body, unit, into the body; only for kFace
  Range volumes;           // rows in `fixed_volumes`; kPoint and kFace have none
};

enum class VolumeKind : std::uint32_t { kBox, kSphere };

/// A unit box (side 2) or unit sphere (radius 1) whose image fixes what of the body lies in it.
/// Written by: load.
struct FixedVolume {
  glm::dmat3 to_unit{1.0};  // unit = to_unit * (x_body - center)
  glm::dvec3 center{0.0};   // m, body
  VolumeKind kind = VolumeKind::kBox;
  std::uint32_t padding = 0;
};

enum class ContactModel : std::uint32_t { kAuto, kPaper, kMdr, kPatch };
enum class BodyModel : std::uint32_t { kAuto, kNone, kSkeleton, kCompliance };

/// What the scene asked for and, once prepared, what runs (never kAuto). Written by: load.
struct BodyModels {
  ContactModel contact = ContactModel::kAuto;
  BodyModel body = BodyModel::kAuto;
  double tolerance = 0.05;        // relative error in the torque that kAuto may make
  double region_threshold = 0.0;  // r_th, m; at least what the sampling resolves
};

/// Which rows of other tables belong to a tool or body. Written by: load.
struct OwnedRows {
  Range parts;       // in `parts`
  Range samples;     // in `samples`; tools only
  Range balls;       // in `balls`; tools only
  Range anchors;     // in `anchors`; bodies only
  Range influences;  // in `influences`; bodies with contact model patch only: its tables and, of a
                     // layer with body model compliance, its kernel (layer_kernel.hpp)
  Range ports;       // in `ports`; body model compliance only, the first of them are its anchors
  Range compliance;  // in `compliance`, 3 rows a port of 3 numbers a port, displacements by the
                     // force there, m/N; then 3 rows a port of 3 an anchor, turns by it, rad/N
};

/// Axis-aligned box of the rest shape in the owner's frame. Written by: load.
struct Bounds {
  glm::dvec3 lowest{0.0};   // m
  glm::dvec3 highest{0.0};  // m
};

// --------------------------------------------------------------------------------------------------------
// tools

/// The tool node's frame in the world, now and one step ago. Written by: couple_tools.
struct ToolPose {
  Pose now;
  Pose before;
};

/// Motion over the step, of the mass centre. Written by: couple_tools.
struct ToolMotion {
  glm::dvec3 velocity{0.0};          // m/s, world
  glm::dvec3 angular_velocity{0.0};  // rad/s, world
  glm::dvec3 mass_center{0.0};       // m, world
  glm::dvec3 axis{
      0.0};  // world, unit once the tool has turned: the rotation axis with a short memory
  double axis_turn = 0.0;  // rad, how much turning that memory holds
};

/// Written by: load.
struct MassProperties {
  double mass = 1.0;        // kg
  glm::dvec3 center{0.0};   // m, tool: mass centre
  glm::dmat3 inertia{0.0};  // kg m^2 about the mass centre, tool axes
};

enum class WrenchState : std::uint32_t { kLive, kFalling, kRising };

/// The product: what the bodies exert on the tool, about its mass centre, world frame. Written by:
/// sum_wrenches.
struct ToolWrench {
  Wrench total;        // as let out
  Wrench held;         // what was let out when a fault began; fades from there
  double work = 0.0;   // J, done by the tool's holder so far
  double share = 1.0;  // of `held` (falling) or of the computed wrench (rising) that is let out
  WrenchState state = WrenchState::kLive;
  std::uint32_t padding = 0;
};

// ------------------------------------------------------------------------------------------------------
// regions Rows are in the order of formation. A region of a step continues the one of the last step
// that it overlaps most.

/// Written by: group_regions.
struct RegionIdentity {
  Entity self;
  std::uint32_t body = 0;   // row in `bodies`
  std::uint32_t tool = 0;   // row in `tools`
  std::uint64_t order = 0;  // 0, 1, 2, ... in the order of formation, never used twice
  Range cells;              // its rows in `cells`: grid_side x grid_side, x fastest
};

/// The grid's placement. Its x and y axes keep their direction as well as the turning normal lets
/// them. Written by: group_regions and region_grids.
struct RegionFrame {
  glm::dvec3 origin{0.0};               // m, body: on the rest surface, centre of the grid
  glm::dvec3 tangent_x{1.0, 0.0, 0.0};  // body, unit
  glm::dvec3 tangent_y{0.0, 1.0, 0.0};  // body, unit
  glm::dvec3 normal{0.0, 0.0, 1.0};     // body, unit, out of the body: tangent_x x tangent_y
  glm::dvec2 half_size{0.0};            // m: the grid covers origin +- half_size
};

/// How the material under the region has moved from where the rest shape has it, as a rigid body.
/// Contact is found against the rest shape, so the tool is seen from the moved material. Written
/// by: the contact model; zero for `paper`.
struct RegionCarrier {
  glm::dvec3 translation{0.0};  // m, body, of the grid's origin
  glm::dvec3 rotation{0.0};     // rad, body: rotation vector
};

/// How the whole body's deformation has moved the material under the region, as a rigid body.
/// Written by: compliance; zero with other body models.
struct RegionSupport {
  glm::dvec3 about{0.0};             // m, body: the point that has gone by `translation`
  glm::dvec3 translation{0.0};       // m, body
  glm::dvec3 rotation{0.0};          // rad, body: rotation vector
  glm::dvec3 translation_step{0.0};  // m: by the last step
  glm::dvec3 rotation_step{0.0};     // rad
  // The part of it that the body's other regions have to do with; the rest is by its own load.
  glm::dvec3 translation_by_others{0.0};  // m, body, likewise
  glm::dvec3 rotation_by_others{0.0};     // rad
};

inline constexpr std::uint32_t kSupportTerms = 15;

/// How the whole body's deformation moves the material under the region beyond RegionSupport: a
/// polynomial of the fourth degree in two coordinates along the surface. Written by: compliance;
/// zero with other body models.
struct SupportField {
  glm::dvec3 origin{0.0};   // m, body
  glm::dvec3 along_x{0.0};  // 1/m, body: coordinate x is dot(along_x, point - origin)
  glm::dvec3 along_y{0.0};
  std::array<glm::dvec3, kSupportTerms> terms{};  // m, body: of 1; x, y; x^2, x y, y^2; x^3, ...
};

/// Where the tractions are: the grid as it was when they were last carried over to it, moved since
/// with the material where that sticks; half_size 0 before the first time. Written by:
/// group_regions and carry_tractions.
struct TractionFrame {
  RegionFrame frame;
};

/// Written by: region_grids.
struct RegionGeometry {
  glm::dvec3 equivalent_point{0.0};  // m, body: p_eq, the pressure centre, on the tool's surface
  glm::dvec3 rest_point{0.0};        // m, body: where p_eq was on the body's rest surface
  double area = 0.0;                 // m^2
  double radius = 0.0;               // m: a = sqrt(area / pi)
  double mean_depth = 0.0;           // m: x, the overlap's mean over the area
  double largest_depth = 0.0;        // m
  glm::dvec3 mean_normal{0.0};       // body, unit: of the rest surface, mean over the area
};

/// Motion of the tool over the body at the region. Written by: region_motion.
struct RegionMotion {
  glm::dvec2 pivot{0.0};  // m, grid: where the axis goes through the region; p_eq when it misses it
  glm::dvec2 slide{0.0};  // m, grid: tangential motion of the tool at the pivot in this step
  glm::dvec3 axis{0.0};   // body, unit; zero before the tool has turned
  double spin = 0.0;      // rad: turn about the normal in this step
  double turn = 0.0;      // rad: phi, the sum of spin since the region formed
  double axis_share = 0.0;  // 1: the rotation axis goes through the region; 0: it misses it
  double lever = 0.0;  // m: l of the paper, distance to the fixed point along the axis, at least a
};

/// Written by: normal_forces.
struct RegionNormal {
  double force = 0.0;      // N: F_n without rotation, along the outward normal on the tool
  double stiffness = 0.0;  // N/m: dF/dx
};

/// Written by: friction_forces.
struct RegionFriction {
  glm::dvec2 force{0.0};       // N, grid, on the tool
  double couple = 0.0;         // N m, about the normal through p_eq, on the tool
  double kinetic_share = 0.0;  // 0: threshold mu_s and elastic traction; 1: mu_d along the slip
  double stick_radius = 0.0;   // m: r_m, at most a
  double stick_turn = 0.0;     // rad: phi at r_m that the body's surface follows (phi_m)
  double stick_share = 0.0;    // of the area that sticks: there the body moves with the tool
};

/// How the contact model `patch` stands in a region. Written by: patch_forces.
struct PatchState {
  glm::dvec2 slide{0.0};      // m, grid: motion of the last step, as in RegionMotion
  double spin = 0.0;          // rad, likewise
  double deepened = 0.0;      // m: change of the largest depth in the last step
  double depth = 0.0;         // m: the largest depth
  double residual = 0.0;      // of the pressures and tractions, relative to the mean pressure
  std::uint32_t sweeps = 0;   // in the last step
  std::uint32_t started = 0;  // 0: no solution yet
  std::uint32_t moved = 0;    // 1: the grid has moved, displacements must be found anew
  std::uint32_t padding = 0;
};

/// Where smooth exact shapes lie deepest in each other in a region with contact model `mdr`.
/// Written by: mdr_contacts.
struct SmoothContact {
  double share = 0.0;        // 1: known from the shapes; 0: not, what the cells show counts
  double depth = 0.0;        // m, along the common normal
  glm::dvec2 place{0.0};     // m, grid
  double curvature_1 = 0.0;  // 1/m, principal, of both surfaces together
  double curvature_2 = 0.0;  // 1/m, the larger
  double beyond = 0.0;  // how far the surfaces part at the edge beyond their paraboloid, relative
};

/// How the contact model `mdr` stands in a region. Written by: mdr_forces.
struct MdrState {
  double radius = 0.0;      // m: a of the last step, 0 before the first
  double elongation = 0.0;  // 1 - b / a
  double flat_share = 0.0;  // of the force: by a flat punch's pressure, the rest by a paraboloid's
  double kinetic_share = 0.0;  // 0: mu_s, 1: mu_d
};

inline constexpr std::uint32_t kFieldDiscs = 10;
inline constexpr std::uint32_t kFieldBlocks = 5;

/// Normal force that a part of a region presses into the body.
struct PressedBlock {
  glm::dvec2 place{0.0};  // m, grid: its pressure centre
  double force = 0.0;     // N
};

/// What a region of an elastic half-space does to the body around it, small enough for a snapshot:
/// bonded discs turned by small angles, and forces. Their exact fields add up to that of the
/// region. Written by: region_fields; all zero for contact model `paper`.
struct RegionField {
  glm::dvec2 center{0.0};         // m, grid: of the discs
  double radius = 0.0;            // m: of the largest disc; 0: there is no such field
  double spread = 0.0;            // m: width over which the force of a block is spread
  double turn[kFieldDiscs] = {};  // rad: of the disc of radius (j + 1) / kFieldDiscs * radius
  PressedBlock blocks[kFieldBlocks * kFieldBlocks];
};

inline constexpr std::uint32_t kAnchorsPerBody = 48;

/// Angle about the region's normal by which each anchor of its body turns because of the region,
/// beyond what the half-space under the region does there; small angles. With it a picture can turn
/// the body as far as it turns, where AnchorMotion alone would move it along tangents. Written by:
/// anchor_motions; all zero with other body models than compliance.
struct AnchorTurns {
  double turn[kAnchorsPerBody] = {};  // rad
  // How far the material under the contact has gone round at distance r from rest_point, rad,
  // as RegionSupport and SupportField have it, from which the contact sees the tool:
  double support = 0.0;         // rad: at r = 0
  double support_growth = 0.0;  // rad/m^2: times r^2, what it is more
};

/// Written by: region_wrenches.
struct RegionWrench {
  Wrench on_tool;            // world, about the tool's mass centre, as let out
  Wrench event_change;       // world: what birth, merge or split would have made jump; fades out
  double event_share = 0.0;  // of event_change still let out: 1 at the event, 0 when faded
  std::uint32_t event_now =
      0;  // 1: on_tool holds what this region takes over; group_regions sets it
  std::uint32_t padding = 0;
};

// --------------------------------------------------------------------------------------------------------
// cells

/// One cell of a region's grid. Written by: region_grids.
struct CellGeometry {
  double height = 0.0;    // m, grid: z of the tool's surface under the cell's centre
  double depth = 0.0;     // m: overlap along the normal, <= 0 outside the contact
  double coverage = 0.0;  // share of the cell's area that is in contact, 0 to 1
};

/// Written by: carry_tractions and the friction forces of the contact model.
struct CellTraction {
  glm::dvec2 traction{0.0};    // Pa, grid, on the tool, per covered area
  double pressure = 0.0;       // Pa
  double kinetic_share = 0.0;  // 0: threshold mu_s; 1: mu_d, after slipping a slip length
  double coverage = 0.0;       // share of the cell that the traction acts on
  std::uint32_t sticks = 0;    // 1: sticks, 0: slips or carries nothing
  std::uint32_t padding = 0;
};

/// One value of the influence tables that fill_influences
/// (systems/contact_models/influence.hpp) makes. Written by: load.
struct Influence {
  double value = 0.0;
};

/// What a region's own tables in `layer_influences` were filled for; zero before. Written by:
/// patch_forces.
struct LayerGrid {
  double thickness = 0.0;     // m
  glm::dvec2 half_size{0.0};  // m
};

/// The body's surface under one cell of a region with contact model `patch`. Written by:
/// patch_forces.
struct PatchCell {
  glm::dvec2 displacement{0.0};  // m, grid: of the local half-space, tangential
  double depression = 0.0;       // m: into the body
  glm::dvec2 held{0.0};          // m, grid: the displacement at which friction holds or has left it
  std::uint32_t known = 0;       // 0: `held` is what the displacement is
  std::uint32_t padding = 0;
};

/// What the last step changed of it, from which the next one starts. Written by: patch_forces.
struct PatchChange {
  glm::dvec2 traction{0.0};      // Pa, grid, on the body
  double pressure = 0.0;         // Pa
  glm::dvec2 displacement{0.0};  // m, grid
  double depression = 0.0;       // m
};

inline constexpr std::uint32_t kMdrLayers = 32;

/// One layer of springs of a region with contact model `mdr`: how far the tool has deflected it.
/// Written by: mdr_forces.
struct MdrLayer {
  glm::dvec2 shift{0.0};  // m, grid
  double turn = 0.0;      // rad
};

// ------------------------------------------------------------------------------------------------------
// anchors

/// A point of the body's rest surface at which the body model gives displacement. Written by: load.
struct AnchorRest {
  glm::dvec3 position{0.0};  // m, body
};

/// A point of the rest surface of a body with body model `compliance` between which and the others
/// it is known what forces do. Written by: load.
struct CompliancePort {
  glm::dvec3 position{0.0};  // m, body
  glm::dvec3 normal{0.0};    // body, unit, outward
};

/// One value of the matrix of a body with body model `compliance`: how forces at its ports move the
/// material beyond what half-spaces do. Written by: load.
struct ComplianceValue {
  double value = 0.0;  // m/N, rad/N
};

inline constexpr std::uint32_t kFootingPorts = 32;

/// How a region stands on the ports around it: what its tractions are as forces at them, and how
/// their displacements make a SupportField. Laid anew when the contact has moved or grown. Written
/// by: compliance.
struct Footing {
  glm::dvec3 origin{0.0};     // m, body
  glm::dvec3 tangent_x{0.0};  // body, unit
  glm::dvec3 tangent_y{0.0};
  glm::dvec3 normal{0.0};
  double reach = 0.0;          // m: of the ports, and unit of the coordinates; 0: never laid
  glm::dvec3 center{0.0};      // m, body: of the contact for which it was laid
  double radius = 0.0;         // m: of that contact
  double share = 1.0;          // of the displacements that is let through (below)
  std::uint64_t serial = 0;    // no two that were laid have the same
  std::uint32_t on_layer = 0;  // 1: not the ports but `own` moves it, all of it
  std::uint32_t count = 0;     // of the ports
  std::array<std::uint32_t, kFootingPorts> ports{};
  std::array<std::array<double, kFootingPorts>, kSupportTerms> fit{};  // term by displacement
  // Forces at the ports that are a unit wrench about `center`, spread as a rigid disc would.
  std::array<std::array<glm::dvec3, kFootingPorts>, 6> unit_forces{};
  std::array<double, 36> own{};  // 6 x 6: motion at `center` by that unit wrench, what yields of it
};

inline constexpr std::uint32_t kSupportColumn = 16;  // terms of one axis, with one more of zero

/// What becomes of a region's tractions through its footing's ports: the three axes' terms,
/// body axes, by the tractions' moments with their terms, m/N. Column by column; in a column and
/// from one column to the next kSupportColumn an axis. Written by: patch_forces.
struct FootingResponse {
  std::uint64_t serial = 0;  // of the footing for which it was found
  std::array<double, std::size_t{9} * kSupportColumn * kSupportColumn> terms{};
};

/// 6 x 6, body axes: how a wrench on one region moves the material under another one. Written by:
/// compliance.
struct RegionCoupling {
  std::uint64_t serial_to = 0;  // of the footings between which it was found
  std::uint64_t serial_from = 0;
  std::array<double, 36> motion{};
};

/// Sum over the body's regions. Written by: the body model (systems/body_models/).
struct AnchorMotion {
  glm::dvec3 displacement{0.0};  // m, body
};

inline constexpr std::uint32_t kBeamStations = 16;

/// Sections of the straight beam from an anchor to the fixed point, root first: cut perpendicular
/// to the beam. Written by: load.
struct BeamSection {
  double area = 0.0;              // A, m^2
  double bending_xx = 0.0;        // I about the first transverse axis, m^4
  double bending_yy = 0.0;        // I about the second transverse axis, m^4
  double bending_xy = 0.0;        // product of inertia, m^4
  double torsion_constant = 0.0;  // J of Saint-Venant, m^4
  double polar = 0.0;             // polar second moment, m^4
};

// ------------------------------------------------------------------------------------------- the
// frame's tables Rows that the GPU reads as they are: float, 16-byte rows or single floats.

/// Written by: load.
struct VertexRest {
  glm::vec4 position{0.0F};  // m, body; w = 1 if the vertex is fixed, else 0
};

/// Written by: load.
struct VertexNormal {
  glm::vec4 normal{0.0F};  // body, unit; w unused, 0
};

/// Written by: surface_field.
struct VertexDisplacement {
  glm::vec4 displacement{0.0F};  // m, body; w = normal contact pressure, Pa, for the heat map
};

/// Twist about one region's axis. Rows of a body: region-major, kMaxRegionsPerBody blocks of its
/// vertex count. Written by: surface_field.
struct TwistAngle {
  float angle = 0.0F;  // rad
};

/// Three vertex rows, relative to the body's first vertex. Written by: load.
struct Triangle {
  glm::uvec3 vertices{0};
};

/// The axis about which a body's region slot turns vertices. Written by: surface_field.
struct TwistAxis {
  glm::vec4 point{0.0F};      // m, body; w unused, 0
  glm::vec4 direction{0.0F};  // body, unit; w unused, 0
};

/// One drawn thing: a body, or a tool. Written by: load.
struct DrawRange {
  Range vertices;         // in the vertex table of its kind
  Range triangles;        // likewise
  glm::vec4 color{0.8F};  // linear RGB, alpha
};

}  // namespace torsion
