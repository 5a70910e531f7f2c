#include "ecs/assert.hpp"
#include "torsion/types.hpp"

namespace torsion {

AssertionHandler set_assertion_handler(AssertionHandler handler) noexcept {
  return engine::detail::assertion_handler.exchange(handler);
}

const char* version() noexcept {
  return TORSION_VERSION;
}

}  // namespace torsion
