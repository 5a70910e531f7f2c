#pragma once

#include <cstdint>
#include <vector>

#include <tiny_gltf.h>

namespace torsion::engine {

/// The elements of a checked accessor as numbers, component after component: strides, sparse
/// replacements and quantised (normalised) integers resolved, missing buffer views zero.
/// @pre `model` is what read_gltf_file() returned, `accessor` one of its accessors
std::vector<double> read_numbers(const tinygltf::Model& model, int accessor);

/// The elements of a scalar accessor of unsigned integers: indices.
/// @pre as above
std::vector<std::uint32_t> read_indices(const tinygltf::Model& model, int accessor);

/// Which elements a sparse accessor replaces. @pre as above, and the accessor is sparse
std::vector<std::uint32_t> read_sparse_indices(const tinygltf::Model& model, int accessor);

}  // namespace torsion::engine
