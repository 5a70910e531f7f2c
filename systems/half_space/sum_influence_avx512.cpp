// Compiled for AVX-512 with fused multiply-adds (systems/CMakeLists.txt).

#include "systems/half_space/sum_influence_block.hpp"

namespace torsion::engine {

void sum_influence_avx512(const InfluenceSums& sums) {
  influence_block::sum_all<8>(sums);
}

}  // namespace torsion::engine
