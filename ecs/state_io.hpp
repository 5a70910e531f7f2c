#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "ecs/result.hpp"
#include "ecs/state.hpp"

namespace torsion::engine {

// A saved state: magic, version, a hash of the layout of every saved type, the hash of its model,
// the tables with their capacities, and a checksum. A state that is loaded has the hash() of the
// one that was saved and goes on bit for bit with the same model. The format is this build's own:
// another layout of the components is refused, not converted.

/// The state as bytes. Load time: it reads all of the model.
[[nodiscard]] std::vector<std::byte> to_bytes(const Model& model, const State& state);

/// The state that `bytes` hold. Fails on anything cut short, changed, of another version, layout or
/// model, or naming rows that do not exist. `origin` is how messages call the source.
Result<State> from_bytes(std::span<const std::byte> bytes, const Model& model,
                         std::string_view origin);

/// Writes the state to `path` by way of a temporary file beside it, so that `path` is never
/// half-written.
Result<Done> save_state(const Model& model, const State& state, const std::filesystem::path& path);

/// Reads what save_state wrote; fails as from_bytes does, and if `path` cannot be read.
Result<State> load_state(const Model& model, const std::filesystem::path& path);

}  // namespace torsion::engine
