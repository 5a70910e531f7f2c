#include "systems/contact_models/region_fields.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "systems/frames.hpp"
#include "systems/scratch.hpp"

namespace torsion {
namespace {

// A square load of width b sinks in its middle as deep as a point load spread over b / (4 ln(1 +
// sqrt(2))) (Johnson, 1985, eq. 3.25).
constexpr double kSpreadOverBlock = 0.2837;

/// One region at work.
struct Source {
  const RegionFrame& frame;
  std::uint32_t side;
  double cell_area;  // m^2
  std::span<const CellTraction> tractions;
};

/// Shares `force` among the blocks as the cells press; the pressure centre.
glm::dvec2 press_blocks(const Source& source, double force_in_all, RegionField& field) {
  glm::dvec2 center(0.0);
  double total = 0.0;
  std::uint32_t cell = 0;
  for (std::uint32_t j = 0; j < source.side; ++j) {
    for (std::uint32_t i = 0; i < source.side; ++i, ++cell) {
      const CellTraction& traction = source.tractions[cell];
      const double force = traction.pressure * traction.coverage * source.cell_area;
      if (force <= 0.0) {
        continue;
      }
      const glm::dvec2 place = cell_center(source.frame, source.side, i, j);
      PressedBlock& block = field.blocks[j * kFieldBlocks / source.side * kFieldBlocks +
                                         i * kFieldBlocks / source.side];
      block.force += force;
      block.place += place * force;
      center += place * force;
      total += force;
    }
  }
  for (PressedBlock& block : field.blocks) {
    block.place = block.force > 0.0 ? block.place / block.force : glm::dvec2(0.0);
    block.force *= total > 0.0 ? force_in_all / total : 0.0;
  }
  return total > 0.0 ? center / total : glm::dvec2(0.0);
}

/// Couples of the rings on the material, each cell's shared between the two nearest ring middles.
std::array<double, kFieldDiscs> ring_couples(const Source& source, const RegionField& field) {
  std::array<double, kFieldDiscs> couples{};
  std::uint32_t cell = 0;
  for (std::uint32_t j = 0; j < source.side; ++j) {
    for (std::uint32_t i = 0; i < source.side; ++i, ++cell) {
      const CellTraction& traction = source.tractions[cell];
      const glm::dvec2 arm = cell_center(source.frame, source.side, i, j) - field.center;
      const glm::dvec2 force =
          traction.traction * (-traction.coverage * source.cell_area);  // on the material
      const double couple = arm.x * force.y - arm.y * force.x;
      const double place =
          std::clamp(glm::length(arm) / field.radius * kFieldDiscs - 0.5, 0.0, kFieldDiscs - 1.0);
      const auto ring = std::min(static_cast<std::size_t>(place), std::size_t{kFieldDiscs - 2});
      const double outer = place - static_cast<double>(ring);
      couples[ring] += (1.0 - outer) * couple;
      couples[ring + 1] += outer * couple;
    }
  }
  return couples;
}

/// Puts a disc of any radius on the two nearest of the field's, with its angle and its couple.
void add_disc(RegionField& field, double radius_share, double turn) {
  const double place = std::clamp(radius_share * kFieldDiscs, 1.0, double{kFieldDiscs});
  const auto lower = std::min(static_cast<std::size_t>(place), std::size_t{kFieldDiscs - 1});
  const auto cube = [](double x) {
    return x * x * x;
  };
  const auto low = static_cast<double>(lower);
  const double share = (cube(place) - cube(low)) / (cube(low + 1.0) - cube(low));
  field.turn[lower - 1] += (1.0 - share) * turn;
  field.turn[lower] += share * turn;
}

/// The springs' deflections grow inwards; each growth is a disc.
void discs_of_layers(const MdrFoundation& foundation, std::span<const MdrLayer> layers,
                     RegionField& field) {
  double place = 1.0;
  double turn = 0.0;
  for (std::size_t k = 0; k < layers.size(); ++k) {
    add_disc(field, 0.5 * (place + foundation.place[k]), layers[k].turn - turn);
    place = foundation.place[k];
    turn = layers[k].turn;
  }
}

void fill_field(StepContext& context, std::uint32_t region, ContactModel model) {
  World& world = context.world;
  const RegionIdentity& identity = world.regions.at<RegionIdentity>(region);
  const RegionFrame& frame = world.regions.at<RegionFrame>(region);
  const std::uint32_t side = world.settings.at<Settings>(0).grid_side;
  const glm::dvec2 cell = 2.0 * frame.half_size / static_cast<double>(side);
  const Source source{frame, side, cell.x * cell.y, world.cells.rows<CellTraction>(identity.cells)};
  RegionField& field = world.regions.at<RegionField>(region);
  field = RegionField{};
  field.radius = world.regions.at<RegionGeometry>(region).radius;
  if (field.radius <= 0.0) {
    return;
  }
  field.spread = kSpreadOverBlock * 2.0 * std::min(frame.half_size.x, frame.half_size.y) /
                 static_cast<double>(kFieldBlocks);
  field.center = press_blocks(source, world.regions.at<RegionNormal>(region).force, field);
  if (model == ContactModel::kMdr) {
    const std::uint32_t block = block_of(identity);
    const MdrState& state = world.regions.at<MdrState>(region);
    const MdrPlaces places =
        places_of(context.scratch.mdr_tables, {state.flat_share, state.elongation});
    discs_of_layers(places.turn, world.mdr_layers.rows<MdrLayer>({block * kMdrLayers, kMdrLayers}),
                    field);
    return;
  }
  const double shear_modulus = world.bodies.at<Elasticity>(identity.body).shear_modulus();
  discs_of_ring_couples(ring_couples(source, field), field.radius, shear_modulus, field.turn);
}

}  // namespace

void discs_of_ring_couples(std::span<const double> couples, double radius, double shear_modulus,
                           std::span<double> turn) {
  // Couple that a disc of radius s has outside r, over 8 G phi.
  const auto beyond = [](double s, double r) {
    const double square = std::max(s * s - r * r, 0.0);
    const double root = std::sqrt(square);
    return s * s * root - square * root / 3.0;
  };
  const double width = radius / kFieldDiscs;
  for (std::size_t j = kFieldDiscs; j-- > 0;) {
    const double inner = static_cast<double>(j) * width;
    double couple = couples[j];
    for (std::size_t k = j + 1; k < kFieldDiscs; ++k) {
      const double s = static_cast<double>(k + 1) * width;
      couple -= 8.0 * shear_modulus * turn[k] * (beyond(s, inner) - beyond(s, inner + width));
    }
    turn[j] = couple / (8.0 * shear_modulus * beyond(inner + width, inner));
  }
}

void region_fields(StepContext& context) {
  const World& world = context.world;
  for (std::uint32_t region = 0; region < world.regions.size(); ++region) {
    const std::uint32_t body = world.regions.at<RegionIdentity>(region).body;
    const ContactModel model = world.bodies.at<BodyModels>(body).contact;
    if (model == ContactModel::kMdr || model == ContactModel::kPatch) {
      fill_field(context, region, model);
    }
  }
}

}  // namespace torsion
