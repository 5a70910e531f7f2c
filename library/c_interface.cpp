#include "library/c_interface.hpp"

namespace torsion::c_interface {
namespace {

std::string& last_error() {
  thread_local std::string text;
  return text;
}

}  // namespace

int failed(const char* why) noexcept {
  try {
    last_error() = why;
  } catch (const std::exception&) {
    last_error().clear();  // no memory for the words
  }
  return kFailed;
}

std::shared_ptr<const Model> model_of(const torsion_model* handle) {
  for (;;) {
    const HandleUse<torsion_model> use(handle);
    if (use.state() == HandleState::kBusy) {
      continue;  // for as long as a pointer is copied
    }
    if (const char* const problem = problem_of(use)) {
      failed(problem);
      return nullptr;
    }
    return *use;
  }
}

}  // namespace torsion::c_interface

uint32_t torsion_interface_version(void) {
  return TORSION_INTERFACE_VERSION;
}

const char* torsion_version(void) {
  return torsion::version();
}

const char* torsion_last_error(void) {
  return torsion::c_interface::last_error().c_str();
}

void torsion_set_assertion_handler(void (*handler)(const char*, const char*, int)) {
  torsion::set_assertion_handler(handler);
}
