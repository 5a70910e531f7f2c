#include "systems/contact/support/footing_response.hpp"

#include "systems/math/lanes.hpp"

namespace torsion {
namespace {

/// Values of one port or one row: the terms side by side in vectors, so that no sum is split.
using TermRow = std::array<double, kSupportColumn>;

TORSION_WIDEST
void add_terms(double scale, const TermRow& __restrict from, double* __restrict to) {
  for (std::size_t k = 0; k < kSupportColumn; ++k) {
    to[k] += scale * from[k];
  }
}

/// The fit with the terms of each port together.
std::array<TermRow, kFootingPorts> terms_by_port(const Footing& footing) {
  std::array<TermRow, kFootingPorts> terms{};
  for (std::size_t k = 0; k < kSupportTerms; ++k) {
    for (std::size_t p = 0; p < footing.count; ++p) {
      terms[p][k] = footing.fit[k][p];
    }
  }
  return terms;
}

}  // namespace

void find_response(const PortCompliance& body, const Footing& footing, FootingResponse& response) {
  response.serial = footing.serial;
  response.terms.fill(0.0);
  const std::array<TermRow, kFootingPorts> fit = terms_by_port(footing);
  const std::size_t side = 3 * body.ports.size();
  for (std::size_t force = 0; force < 3; ++force) {
    for (std::size_t to = 0; to < footing.count; ++to) {
      // What unit moments of this axis do to the port, along each axis.
      std::array<TermRow, 3> moved{};
      for (std::size_t from = 0; from < footing.count; ++from) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const double value = body.values[(3 * std::size_t{footing.ports[to]} + axis) * side +
                                           3 * std::size_t{footing.ports[from]} + force]
                                   .value;
          add_terms(footing.share * value, fit[from], moved[axis].data());
        }
      }
      for (std::size_t moment = 0; moment < kSupportTerms; ++moment) {
        double* const column =
            &response.terms[(force * kSupportColumn + moment) * 3 * kSupportColumn];
        for (std::size_t axis = 0; axis < 3; ++axis) {
          add_terms(moved[axis][moment], fit[to], column + axis * kSupportColumn);
        }
      }
    }
  }
}

}  // namespace torsion
