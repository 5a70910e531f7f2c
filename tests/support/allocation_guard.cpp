#include "tests/support/allocation_guard.hpp"

#include <cerrno>
#include <cstddef>

namespace {

// Plain thread-local integers: touching them never allocates, so the counting cannot count itself.
constinit thread_local std::uint64_t allocation_count = 0;
constinit thread_local std::uint64_t release_count = 0;

void count_release(const volatile void* block) {
  release_count += block != nullptr ? 1U : 0U;
}

}  // namespace

#ifdef TORSION_SANITIZED

// A sanitizer owns malloc, but lets us listen.
extern "C" int
__sanitizer_install_malloc_and_free_hooks(  // NOLINT(readability-identifier-naming): its name
    void (*on_malloc)(const volatile void*, std::size_t), void (*on_free)(const volatile void*));

namespace {

void count_allocation(const volatile void* /*block*/, std::size_t /*bytes*/) {
  allocation_count += 1;
}

[[maybe_unused]] const int kHooksInstalled =
    __sanitizer_install_malloc_and_free_hooks(count_allocation, count_release);

}  // namespace

#else

// glibc lets a program define the malloc family and keeps its own under these names. operator new
// ends in them too.
extern "C" {
// NOLINTBEGIN(readability-identifier-naming): glibc's names
void* __libc_malloc(std::size_t bytes);
void* __libc_calloc(std::size_t count, std::size_t bytes);
void* __libc_realloc(void* block, std::size_t bytes);
void* __libc_memalign(std::size_t alignment, std::size_t bytes);
void __libc_free(void* block);
// NOLINTEND(readability-identifier-naming)

void* malloc(std::size_t bytes) {
  allocation_count += 1;
  return __libc_malloc(bytes);
}

void* calloc(std::size_t count, std::size_t bytes) {
  allocation_count += 1;
  return __libc_calloc(count, bytes);
}

void* realloc(void* block, std::size_t bytes) {
  allocation_count += 1;
  count_release(block);
  return __libc_realloc(block, bytes);
}

void* memalign(std::size_t alignment, std::size_t bytes) {
  allocation_count += 1;
  return __libc_memalign(alignment, bytes);
}

void* aligned_alloc(std::size_t alignment, std::size_t bytes) {
  allocation_count += 1;
  return __libc_memalign(alignment, bytes);
}

int posix_memalign(void** block, std::size_t alignment, std::size_t bytes) {
  allocation_count += 1;
  void* const taken = __libc_memalign(alignment, bytes);
  if (taken == nullptr) {
    return ENOMEM;
  }
  *block = taken;
  return 0;
}

void free(void* block) {
  count_release(block);
  __libc_free(block);
}
}

#endif

namespace torsion::engine::test {

AllocationGuard::AllocationGuard()
    : allocations_before_(allocation_count), releases_before_(release_count) {}

std::uint64_t AllocationGuard::allocations() const {
  return allocation_count - allocations_before_;
}

std::uint64_t AllocationGuard::releases() const {
  return release_count - releases_before_;
}

}  // namespace torsion::engine::test
