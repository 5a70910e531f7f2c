#include "python/module.hpp"

#include <stdexcept>

namespace {

/// What a broken precondition is to Python: an exception, where the call may throw.
void raise_assertion(const char* condition, const char* file, int line) {
  throw std::logic_error(std::string(file) + ":" + std::to_string(line) +
                         ": assertion failed: " + condition);
}

}  // namespace

PYBIND11_MODULE(_torsion, module) {
  torsion::set_assertion_handler(raise_assertion);
  module.attr("__version__") = torsion::version();
  torsion::python::add_scene(module);
  torsion::python::add_simulation(module);
  torsion::python::add_surface(module);
}
