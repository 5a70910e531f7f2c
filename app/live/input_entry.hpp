#pragma once

#include <array>
#include <cstdint>

#include "ecs/components.hpp"

namespace torsion::engine {

enum class InputKind : std::uint32_t {
  kPose = 1,  // of tool `index`: values are the pose that it took, then the handle's
  kBody = 2,  // what body `index` is to be from the next kRebuild on: as body_entry() lays it out
  kRebuild = 3,  // the world is made anew of the bodies as chosen and goes on where it was
};

/// Something that went into a run, before step `step`. Entries in order say all that a run depends
/// on besides the scene that it began with.
struct InputEntry {
  InputKind kind = InputKind::kPose;
  std::uint32_t index = 0;
  std::uint64_t step = 0;
  std::array<double, 14> values{};
};
static_assert(sizeof(InputEntry) == 128, "recordings hold these as they are");

/// What may be chosen of a body while a session runs.
struct BodyPick {
  ContactModel contact = ContactModel::kAuto;
  BodyModel body = BodyModel::kAuto;
  Elasticity elasticity;
  Friction friction;
};

/// @param pose    that the tool takes, m, world
/// @param handle  that asked for it; the same where nothing stands between
InputEntry pose_entry(std::uint64_t step, std::uint32_t tool, const Pose& pose, const Pose& handle);
InputEntry body_entry(std::uint64_t step, std::uint32_t body, const BodyPick& pick);

/// The pose that a kPose entry imposes.
Pose pose_of(const InputEntry& entry);
/// What a kBody entry chooses.
BodyPick pick_of(const InputEntry& entry);

/// Whether an entry from a file can be what it says: its kind, and an index below these counts.
bool valid(const InputEntry& entry, std::uint32_t tools, std::uint32_t bodies);

}  // namespace torsion::engine
