#pragma once

// The physics that a glTF carries in its extras: one table for the reader, `torsion check` and
// docs/scenes.md.

#include <array>
#include <cstdint>
#include <limits>
#include <string_view>

#include "ecs/contact_models.hpp"

namespace torsion::engine {

enum class Role : std::uint32_t {
  kNone = 0,
  kElastic = 1,
  kTool = 2,
  kFixedPoint = 4,
  kFixedBox = 8,
  kFixedSphere = 16,
  kPart = 32,   // a mesh below an elastic node or a tool; has no torsion_role
  kScene = 64,  // not a node: the scene itself, and how a window shows it
};

struct RoleName {
  std::string_view name;
  Role role;
};

inline constexpr std::array kRoleNames = {
    RoleName{"elastic", Role::kElastic}, RoleName{"tool", Role::kTool},
    RoleName{"fixed_point", Role::kFixedPoint}, RoleName{"fixed_box", Role::kFixedBox},
    RoleName{"fixed_sphere", Role::kFixedSphere}};

enum class KeyKind : std::uint32_t {
  kNumber,
  kWord,    // one of a few
  kText,    // any
  kVector,  // three numbers
  kFlag,    // true or false; 1 or 0 as Blender writes them
};

/// One key of the extras.
struct SceneKey {
  std::string_view name;
  std::uint32_t roles;  // Role bits of the nodes that it may be on
  KeyKind kind;
  std::string_view allowed;  // in words, with the unit; for a word its values, with spaces between
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool least_is_allowed = true;

  /// Whether a number is within the key's bounds. NaN and infinity are not.
  [[nodiscard]] constexpr bool allows(double number) const {
    return (least_is_allowed ? number >= least : number > least) && number <= most &&
           number <= std::numeric_limits<double>::max();
  }
};

constexpr std::uint32_t operator|(Role a, Role b) {
  return static_cast<std::uint32_t>(a) | static_cast<std::uint32_t>(b);
}
constexpr std::uint32_t bits(Role role) {
  return static_cast<std::uint32_t>(role);
}

// The names of all contact models, with spaces between.
#define TORSION_WORD(name, text) " " text
inline constexpr std::string_view kContactModelWords = "auto" TORSION_CONTACT_MODELS(TORSION_WORD);
#undef TORSION_WORD

inline constexpr std::array kSceneKeys = {
    SceneKey{"torsion_role", ~bits(Role::kScene), KeyKind::kWord,
             "elastic tool fixed_point fixed_box fixed_sphere"},
    SceneKey{"torsion_youngs_modulus", bits(Role::kElastic), KeyKind::kNumber,
             "a number above 0 (Pa)", 0.0, 1e15, false},
    SceneKey{"torsion_poisson_ratio", bits(Role::kElastic), KeyKind::kNumber,
             "a number from 0 to 0.5", 0.0, 0.5},
    SceneKey{"torsion_density", bits(Role::kElastic), KeyKind::kNumber, "a number above 0 (kg/m^3)",
             0.0, 1e6, false},
    SceneKey{"torsion_static_friction", bits(Role::kElastic), KeyKind::kNumber,
             "a number of at least 0 and of at least torsion_dynamic_friction", 0.0, 100.0},
    SceneKey{"torsion_dynamic_friction", bits(Role::kElastic), KeyKind::kNumber,
             "a number of at least 0", 0.0, 100.0},
    SceneKey{"torsion_contact_model", bits(Role::kElastic), KeyKind::kWord, kContactModelWords},
    SceneKey{"torsion_body_model", bits(Role::kElastic), KeyKind::kWord,
             "auto none skeleton compliance"},
    SceneKey{"torsion_tolerance", bits(Role::kElastic), KeyKind::kNumber,
             "a number above 0 and up to 1", 0.0, 1.0, false},
    SceneKey{"torsion_fixed", bits(Role::kElastic), KeyKind::kWord,
             "bottom_center bottom_face attribute children"},
    SceneKey{"torsion_region_threshold", bits(Role::kElastic), KeyKind::kNumber,
             "a number above 0 (m)", 0.0, 1e3, false},
    SceneKey{"torsion_shape", (Role::kElastic | Role::kTool) | bits(Role::kPart), KeyKind::kWord,
             "mesh box sphere ellipsoid cylinder capsule"},
    SceneKey{"torsion_draw", (Role::kElastic | Role::kTool) | bits(Role::kPart), KeyKind::kWord,
             "shape mesh"},
    SceneKey{"torsion_size", (Role::kElastic | Role::kTool) | bits(Role::kPart), KeyKind::kVector,
             "3 numbers above 0 (m, along the node's x, y, z)", 1e-6, 1e6},
    SceneKey{"torsion_mass", bits(Role::kTool), KeyKind::kNumber, "a number above 0 (kg)", 0.0, 1e6,
             false},
    SceneKey{"torsion_center_of_mass", bits(Role::kTool), KeyKind::kVector,
             "3 numbers (m, in the node's frame)", -1e6, 1e6},
    SceneKey{"torsion_device", bits(Role::kTool), KeyKind::kWord, "animation mouse usb"},
    SceneKey{"torsion_title", bits(Role::kScene), KeyKind::kText, "a text"},
    SceneKey{"torsion_caption", bits(Role::kScene), KeyKind::kText, "a text"},
    SceneKey{"torsion_loop", bits(Role::kScene), KeyKind::kFlag, "true or false"},
    SceneKey{"torsion_speed", bits(Role::kScene), KeyKind::kNumber, "a number from 0.01 to 1", 0.01,
             1.0},
    SceneKey{"torsion_colors", bits(Role::kScene), KeyKind::kWord, "material twist pressure"},
    SceneKey{"torsion_stick_slip", bits(Role::kScene), KeyKind::kFlag, "true or false"},
    SceneKey{"torsion_lines", bits(Role::kScene), KeyKind::kFlag, "true or false"},
    SceneKey{"torsion_torque", bits(Role::kScene), KeyKind::kWord, "total parts"},
};

}  // namespace torsion::engine
