#include "systems/contact_models/add_influence.hpp"

#include "systems/widest.hpp"

namespace torsion {

TORSION_WIDEST
void add_influence(const GridBlock& block, const double* table, double scale,
                   double* displacement) {
  const std::uint32_t side = block.side;
  for (std::uint32_t j = 0; j < side; ++j) {
    const double* const from = table + block.first + j * block.width;
    double* __restrict const to = displacement + std::size_t{j} * side;
    for (std::uint32_t i = 0; i < side; ++i) {
      to[i] += scale * from[i];
    }
  }
}

TORSION_WIDEST
void add_two_influences(const GridBlock& block, const double* first, double first_scale,
                        const double* second, double second_scale, double* displacement) {
  const std::uint32_t side = block.side;
  for (std::uint32_t j = 0; j < side; ++j) {
    const std::size_t row = block.first + j * block.width;
    const double* const from_first = first + row;
    const double* const from_second = second + row;
    double* __restrict const to = displacement + std::size_t{j} * side;
    for (std::uint32_t i = 0; i < side; ++i) {
      to[i] += first_scale * from_first[i] + second_scale * from_second[i];
    }
  }
}

}  // namespace torsion
