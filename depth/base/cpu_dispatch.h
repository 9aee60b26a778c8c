#pragma once

// OSSA_CPU_DISPATCH before a function: compiled once for AVX2 and once for any x86-64, picked when
// the program starts. Only where the compiler can do it; elsewhere one version serves.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__)
#define OSSA_CPU_DISPATCH __attribute__((target_clones("avx2", "default")))
#else
#define OSSA_CPU_DISPATCH
#endif

namespace ossa {

/// Whether this processor runs what is written for AVX2 by hand.
inline bool HasAvx2() {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx2") != 0;
#else
  return false;
#endif
}

}  // namespace ossa
