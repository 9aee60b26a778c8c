#pragma once

// OSSA_CPU_DISPATCH before a function compiles it for AVX2 and for any x86-64; the version is
// selected when the program starts. Compilers without support compile one version.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__)
#define OSSA_CPU_DISPATCH __attribute__((target_clones("avx2", "default")))
#else
#define OSSA_CPU_DISPATCH
#endif

namespace ossa {

/// Whether this processor can run hand-written AVX2 code.
inline bool HasAvx2() {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx2") != 0;
#else
  return false;
#endif
}

}  // namespace ossa
