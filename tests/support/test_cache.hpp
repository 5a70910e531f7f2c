#pragma once

#include <cstdlib>

namespace torsion::engine::test {

/// Whether ctest runs this program, with a cache that it has emptied before. Otherwise what a test
/// prepares is computed anew: a cache could hold what the code of yesterday made.
inline bool has_test_cache() {
  return std::getenv("TORSION_CACHE_DIR") != nullptr;  // NOLINT(concurrency-mt-unsafe): only read
}

}  // namespace torsion::engine::test
