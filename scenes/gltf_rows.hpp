#pragma once

#include <cstddef>
#include <span>

#include <tiny_gltf.h>

#include "ecs/components.hpp"

namespace torsion::engine {

/// What an accessor's rows are.
struct RowKind {
  int component = TINYGLTF_COMPONENT_TYPE_FLOAT;
  int type = TINYGLTF_TYPE_SCALAR;
  std::size_t count = 0;
  int target = 0;  // of the buffer view; 0 for none
};

/// Appends bytes to a buffer of the model, from a multiple of four, and makes a view of them.
/// @param target  of the view; 0 for none
/// @return the view's index
int append_view(tinygltf::Model& model, int buffer, std::span<const std::byte> bytes,
                int target = 0);

/// Appends rows to a buffer of the model, from a multiple of four bytes as accessors must
/// (glTF 2.0, 3.6.2.4), and makes a view and an accessor of them.
/// @return the accessor's index
int append_rows(tinygltf::Model& model, int buffer, std::span<const std::byte> rows,
                const RowKind& kind);

/// An accessor of keys' times, with the bounds that it must have.
/// @pre there are some
int append_times(tinygltf::Model& model, int buffer, std::span<const float> times);

/// A channel of an animation, linear between its keys.
/// @param path    translation, rotation or weights
/// @param times   accessor
/// @param values  accessor
void add_channel(tinygltf::Animation& animation, int node, const char* path, int times, int values);

/// The two channels of a node's translation and rotation, and their keys.
/// @param times  accessor, as many as poses
void add_pose_channels(tinygltf::Model& model, tinygltf::Animation& animation, int buffer, int node,
                       int times, std::span<const Pose> poses);

}  // namespace torsion::engine
