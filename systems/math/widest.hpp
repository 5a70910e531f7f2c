#pragma once

// TORSION_WIDEST before a function compiles its loops for the widest vectors that the machine has,
// chosen when the program starts. Without fused multiply-add (CMakeLists.txt) all versions give the
// same bits. Sanitizers start too late for the choice.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define TORSION_WIDEST __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define TORSION_WIDEST
#endif
