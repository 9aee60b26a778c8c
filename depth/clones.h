#pragma once

// OSSA_CLONES before a function: compiled once for AVX2 and once for any x86-64, picked when the
// program starts; OSSA_WIDE_CLONES once more for AVX-512, whose sources must be compiled with
// -ffp-contract=off to say the same everywhere. Only where the compiler can do it; elsewhere one
// version serves.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__)
#define OSSA_CLONES __attribute__((target_clones("avx2", "default")))
#define OSSA_WIDE_CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define OSSA_CLONES
#define OSSA_WIDE_CLONES
#endif
