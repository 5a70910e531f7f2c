#pragma once

// What a contact model is to the rest of the program. systems/laws.cpp has the list of them.

#include <cstdint>
#include <span>
#include <string_view>

#include <glm/mat2x2.hpp>
#include <glm/vec2.hpp>

#include "ecs/schedule.hpp"
#include "ecs/state.hpp"
#include "systems/contact/step_context.hpp"

namespace torsion::engine {

struct RegionPoints;  // systems/contact/scratch.hpp

/// The columns, besides regions' own rows, in which a contact model keeps something from step to
/// step, and from which the twist of the surface under its regions is drawn.
enum class KeptColumns : std::uint8_t {
  kNone,          // the twist is drawn from RegionFriction's stick radius and turn
  kSpringLayers,  // State::mdr_layers: springs of a half-space's contact
  kSurfaceCells,  // State::patch_cells: a half-space's cells, which need influence tables
};

/// One contact model: from a region's overlap and its motion to RegionNormal and RegionFriction.
struct ContactLaw {
  ContactModel model = ContactModel::kAuto;

  // What it knows.
  /// It knows pressure and traction of every cell: where on the material its load lies, and by its
  /// own equations what that does to a body that moves as a whole. Other laws know a contact as a
  /// whole: a force, and a couple about its middle.
  bool by_cells = false;
  /// It accounts for how the body deflects under its load in the step in which that is found
  /// (support/contact_load.hpp): writes ContactScratch::support_answers.
  bool moves_own_support = false;
  /// On a body that moves as a whole: where the body's compliance is more than this many times a
  /// contact's own, regions account for each other's answers within a step (RegionReaction).
  double answers_from = 0.0;
  /// Its force is bounded by the overlap and by the tools' work (region_wrenches.hpp).
  bool is_bounded = true;
  /// It needs RegionMotion on bodies without friction, too.
  bool needs_motion = true;
  KeptColumns keeps = KeptColumns::kNone;
  /// With body model skeleton its force includes the beam of ContactScratch::beams.
  bool takes_beams = false;
  /// It has the compliance of the whole body in its own: a body model would count that twice.
  bool is_of_whole_body = false;
  /// Cells along a side of the grid where the user leaves that open and no tolerance asks for more.
  std::uint32_t grid_side = 16;

  // Its systems: before and after region_motion.
  std::span<const System<StepContext>> place = {};
  std::span<const System<StepContext>> solve = {};

  // A region's grid.
  /// Moves it along with its contact, before cells are sought.
  void (*follow)(StepContext& context, std::uint32_t region, const RegionPoints& contact) = nullptr;
  /// Finds its cells (find_cells in grid_cells.hpp), and regrids where they require it.
  void (*find_cells)(StepContext& context, std::uint32_t region,
                     const RegionPoints& contact) = nullptr;
  /// What it knows of the overlap besides the cells, once all regions have theirs: it may move
  /// Overlap, and RegionFrame's normal with it. Null: nothing.
  void (*refine)(StepContext& context, std::uint32_t region) = nullptr;
  /// Half the sides, at least `least`, m, of a grid that suits it; null: any will do.
  glm::dvec2 (*half_size)(const glm::dvec2& least) = nullptr;
  /// Columns at the grid's left that take no part; null: none.
  std::uint32_t (*spare_columns)(std::uint32_t side) = nullptr;
  /// Whether the grid turns and goes with the material that sticks to the tool (follow_overlap).
  bool follows_material = false;
  /// The grid's axes have been turned: what it keeps in them of the region is turned by `back`.
  /// Null: nothing.
  void (*turn)(State& state, std::uint32_t region, const glm::dmat2& back) = nullptr;

  // What it keeps of a region from step to step. Null: nothing that an event would change.
  /// A new region has this block of cells: forgets whose it was.
  void (*begin)(const Model& model, State& state, std::uint32_t block) = nullptr;
  /// `region` splits off `from`, in group_regions; once its cells are known, `share_out`.
  void (*split)(State& state, std::uint32_t from, std::uint32_t region) = nullptr;
  void (*share_out)(StepContext& context, std::uint32_t region) = nullptr;
  /// `heir` takes over what `ended` holds. Their rows are still what they were.
  void (*join)(StepContext& context, std::uint32_t ended, std::uint32_t heir) = nullptr;
  /// `ended` goes, with or without a join.
  void (*end)(State& state, std::uint32_t ended, std::uint32_t heir) = nullptr;
};

// kPaperLaw and so on, each defined in its own room.
#define TORSION_LAW(name, text) extern const ContactLaw k##name##Law;
TORSION_CONTACT_MODELS(TORSION_LAW)
#undef TORSION_LAW

/// @pre model is not kAuto
const ContactLaw& contact_law(ContactModel model);

/// All of them.
std::span<const ContactLaw* const> contact_laws();

inline const ContactLaw& law_of(const Model& model, std::uint32_t body) {
  return contact_law(model.bodies.at<BodyModels>(body).contact);
}

/// Whether the scene has a tool and a body.
bool any_tool_and_body(const StepContext& context);

/// And a body with that contact model.
bool any_contact_model(const StepContext& context, ContactModel model);

/// And a body with friction.
bool any_friction(const StepContext& context);

/// For System::needed.
template <ContactModel Model>
bool any_with(const StepContext& context) {
  return any_contact_model(context, Model);
}

}  // namespace torsion::engine
