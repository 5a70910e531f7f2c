#pragma once

// What a scene file says, as plain load-time data: scenes/ writes it, systems/prepare.* and
// systems/prepare_frame.* turn it into tables. Nothing here is read by a step.

#include <memory>
#include <string>
#include <vector>

#include "ecs/components.hpp"
#include "ecs/draw_material.hpp"
#include "ecs/motion_script.hpp"
#include "ecs/surface.hpp"

namespace torsion::engine {

/// One closed part of a tool or body.
struct PartDescription {
  std::string node;  // name of the glTF node it comes from
  ShapePart shape;   // kind, pose in the owner's frame, half extents; `field` is not set yet
  SurfaceMesh
      surface;  // m, owner's frame: welded, closed, oriented; always there, also for exact shapes
  // m, owner's frame: of the solid that the part and others which overlap it make, where they do;
  // distances inside the body are to this (systems/unite_meshes.hpp).
  std::shared_ptr<const SurfaceMesh> solid;
};

/// What is drawn: vertices as the file has them (split at hard edges), in the owner's frame.
struct DrawMesh {
  std::vector<glm::vec3> positions;  // m
  std::vector<glm::vec3> normals;    // unit; one for each position
  std::vector<glm::vec2> texcoords;  // of the textures; one for each position, or none
  std::vector<glm::vec3> colors;     // linear rgb, times the material's; likewise
  std::vector<glm::uvec3> triangles;
  std::vector<bool> fixed;  // bodies only: vertices of the fixed region; one for each position
  std::vector<DrawMaterial> materials{1};         // at least one
  std::vector<std::uint32_t> triangle_materials;  // rows of materials, rising; one for each
                                                  // triangle, or none: all are of the first
};

struct BodyDescription {
  std::string node;
  Pose pose;            // body frame in the world, at rest
  MotionScript script;  // links from the root to the body node; no links: nothing animates it
  Elasticity elasticity;
  Friction friction;
  FixedRegion fixed;  // `volumes` counts rows of fixed_volumes below, from 0
  std::vector<FixedVolume> fixed_volumes;
  BodyModels models;
  std::vector<PartDescription> parts;
  DrawMesh draw;
};

struct ToolDescription {
  std::string node;
  std::string device = "animation";  // torsion_device
  MassProperties mass;
  MotionScript script;  // links from the root to the tool node; no keys: the tool stays where it is
  std::vector<PartDescription> parts;
  DrawMesh draw;
};

struct CameraDescription {
  std::string node;
  Pose pose;                            // camera frame in the world: looks along -z, +y up
  double vertical_field_of_view = 0.8;  // rad
  double near_plane = 0.01;             // m
  double far_plane = 100.0;             // m; 0: infinite
};

/// How a window shows a scene at first.
struct SceneView {
  std::string title;          // empty: the file's name
  std::string caption;        // what to look at; may be empty
  bool loop = true;           // begins again after its animation
  double speed = 1.0;         // of real time, up to 1
  std::string colors;         // material, twist or pressure; empty: nobody said
  bool torque_parts = false;  // contact couples apart from what the forces' arms make
  bool lines = true;          // that are fixed to the bodies and to the tools
  bool stick_slip = false;    // marks where the contact sticks and where it slips
};

struct SceneDescription {
  std::string path;
  SceneView view;
  std::vector<BodyDescription> bodies;  // in the order of the file
  std::vector<ToolDescription> tools;   // in the order of the file
  std::vector<CameraDescription> cameras;
  double duration = 0.0;  // s: the end of the longest animation
};

}  // namespace torsion::engine
