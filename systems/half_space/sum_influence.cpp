#include "systems/half_space/sum_influence_block.hpp"

namespace torsion::engine {

void sum_influence(const GridBlock& block, const InfluenceSources& sources, const double* table,
                   const double* scales, const double* start, double* displacement) {
  if (block.side == 1) {  // there is no row for a pair's second
    displacement[0] = (start != nullptr ? start[0] : 0.0) +
                      (sources.count > 0 ? scales[0] * table[block.self] : 0.0);
    return;
  }
  const InfluenceSums sums{block, sources, table, scales, start, displacement};
#ifdef TORSION_WIDE_SUMS
  if (__builtin_cpu_supports("avx512f")) {
    return sum_influence_avx512(sums);
  }
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
    return sum_influence_avx2(sums);
  }
#endif
  influence_block::sum_all<2>(sums);
}

}  // namespace torsion::engine
