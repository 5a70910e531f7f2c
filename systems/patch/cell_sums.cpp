#include "systems/patch/cell_sums.hpp"

#include <array>

#include <glm/geometric.hpp>

#include "systems/math/lanes.hpp"

namespace torsion::engine {
namespace {

/// The sums of sum_cells, in this order.
enum Sum : std::size_t {
  kPressure,
  kPlaceX,  // what is named like PatchSums' numbers but for the pressure, times the pressure
  kPlaceY,
  kHeight,
  kDepth,
  kMovedX,
  kMovedY,
  kMoment,        // of the displacements about the origin
  kSecondMoment,  // of the pressure about the origin
  kTractionX,
  kTractionY,
  kCouple,
  kLoaded,
  kMiddle,   // weights of PatchSums::middle
  kMiddleX,  // times the place
  kMiddleY,
  kStuck,
  kSums
};

template <class Wide>
TORSION_LANES void add_up_cells(std::size_t count, const PatchColumns& columns,
                                const PatchPlaces& places, double reference,
                                std::array<double, kSums>& totals) {
  const Wide one = Wide{} + 1.0;
  const Wide none{};
  const Wide half = none + reference;
  std::array<Wide, kSums> sums{};
  for (std::size_t cell = 0; cell < count; cell += kLanes) {
    const Wide pressure = lanes_at<Wide>(&columns.pressure[cell]);
    const Wide x = lanes_at<Wide>(&places.x[cell]);
    const Wide y = lanes_at<Wide>(&places.y[cell]);
    const Wide moved_x = lanes_at<Wide>(&columns.moved_x[cell]);
    const Wide moved_y = lanes_at<Wide>(&columns.moved_y[cell]);
    const Wide traction_x = lanes_at<Wide>(&columns.traction_x[cell]);
    const Wide traction_y = lanes_at<Wide>(&columns.traction_y[cell]);
    const Wide by_x = pressure * x;
    const Wide by_y = pressure * y;
    const Wide loaded = choose(pressure > 0.0, one, none);
    const Wide covered = loaded * lanes_at<Wide>(&places.share[cell]);
    sums[kPressure] += pressure;
    sums[kPlaceX] += by_x;
    sums[kPlaceY] += by_y;
    sums[kHeight] += pressure * lanes_at<Wide>(&places.height[cell]);
    sums[kDepth] += pressure * lanes_at<Wide>(&columns.depth[cell]);
    sums[kMovedX] += pressure * moved_x;
    sums[kMovedY] += pressure * moved_y;
    sums[kMoment] += by_x * moved_y - by_y * moved_x;
    sums[kSecondMoment] += by_x * x + by_y * y;
    sums[kTractionX] += loaded * traction_x;
    sums[kTractionY] += loaded * traction_y;
    sums[kCouple] += x * traction_y - y * traction_x;
    sums[kLoaded] += covered;
    const Wide weight = covered * (pressure / (pressure + half));
    sums[kMiddle] += weight;
    sums[kMiddleX] += weight * x;
    sums[kMiddleY] += weight * y;
    const Wide left_x = lanes_at<Wide>(&columns.target_x[cell]) - moved_x;
    const Wide left_y = lanes_at<Wide>(&columns.target_y[cell]) - moved_y;
    Wide slide;
    slide_beyond_rounding(traction_x, traction_y, left_x, left_y, moved_x, moved_y, slide);
    sums[kStuck] += covered * choose(slide > 0.0, one - lanes_at<Wide>(&columns.slips[cell]), one);
  }
  for (std::size_t k = 0; k < kSums; ++k) {
    totals[k] = sum_of(sums[k]);
  }
}

/// The pressures' sum by the number of those above 0, or 0.
template <class Wide>
TORSION_LANES double mean_of_loaded(std::size_t count, const double* __restrict pressures) {
  Wide sums{};
  Wide counts{};
  for (std::size_t cell = 0; cell < count; cell += kLanes) {
    const Wide pressure = lanes_at<Wide>(pressures + cell);
    sums += pressure;
    counts += choose(pressure > 0.0, Wide{} + 1.0, Wide{});
  }
  return sum_of(sums) / larger(sum_of(counts), 1.0);
}

}  // namespace

PatchSums sum_cells(const PatchColumns& columns, const PatchPlaces& places, double cell_area,
                    double reference) {
  std::array<double, kSums> totals{};
  TORSION_IN_WIDEST(add_up_cells, whole_lanes(columns.pressure.size()), columns, places, reference,
                    totals);
  PatchSums sums;
  const double pressure = totals[kPressure];
  if (pressure <= 0.0) {
    return sums;
  }
  sums.force = pressure * cell_area;
  sums.center = glm::dvec2(totals[kPlaceX], totals[kPlaceY]) / pressure;
  sums.height = totals[kHeight] / pressure;
  sums.depth = totals[kDepth] / pressure;
  sums.moved = glm::dvec2(totals[kMovedX], totals[kMovedY]) / pressure;
  const double moment =
      totals[kMoment] - pressure * (sums.center.x * sums.moved.y - sums.center.y * sums.moved.x);
  const double second_moment =
      totals[kSecondMoment] - pressure * glm::dot(sums.center, sums.center);
  sums.turn = second_moment > 0.0 ? moment / second_moment : 0.0;
  // The columns' tractions act on the body.
  sums.friction = -cell_area * glm::dvec2(totals[kTractionX], totals[kTractionY]);
  sums.couple = -cell_area * totals[kCouple];
  sums.loaded_cells = totals[kLoaded];
  const double weights = totals[kMiddle];
  sums.middle =
      weights > 0.0 ? glm::dvec2(totals[kMiddleX], totals[kMiddleY]) / weights : sums.center;
  sums.stuck_cells = totals[kStuck];
  return sums;
}

double mean_pressure(const PatchColumns& columns) {
  return TORSION_IN_WIDEST(mean_of_loaded, whole_lanes(columns.pressure.size()),
                           columns.pressure.data());
}

}  // namespace torsion::engine
