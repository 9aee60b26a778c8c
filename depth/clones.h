#pragma once

// OSSA_CLONES before a function: compiled once for AVX2 and once for any x86-64, picked when the
// program starts. Only where the compiler can do it; elsewhere one version serves.
// OSSA_CLONES_FMA: with products that are added in the same step, too, rounded once where they are
// rounded twice elsewhere.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__)
#define OSSA_CLONES __attribute__((target_clones("avx2", "default")))
#define OSSA_CLONES_FMA __attribute__((target_clones("arch=x86-64-v3", "default")))
#else
#define OSSA_CLONES
#define OSSA_CLONES_FMA
#endif
