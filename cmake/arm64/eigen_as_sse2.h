#pragma once
// Included before everything else of ossa's own sources on 64-bit ARM (cmake/ossa_targets.cmake).
//
// Eigen's NEON code sums in another order than its SSE2 code, and rounds a product and its sum once
// instead of twice. Here it compiles its SSE2 code, whose instructions SIMDe spells in NEON, so
// that both processors compute the same bytes. What compilers fuse by themselves -ffp-contract=off
// forbids.
#define SIMDE_ENABLE_NATIVE_ALIASES
#include <simde/x86/sse2.h>

// Of these SIMDe has macros as well, which do not take Eigen's wrapped registers; the functions do.
#undef _mm_slli_epi16
#undef _mm_slli_epi32
#undef _mm_slli_epi64
#undef _mm_srli_epi16
#undef _mm_srli_epi32
#undef _mm_srli_epi64
#define _mm_slli_epi16 (simde_mm_slli_epi16)
#define _mm_slli_epi32 (simde_mm_slli_epi32)
#define _mm_slli_epi64 (simde_mm_slli_epi64)
#define _mm_srli_epi16 (simde_mm_srli_epi16)
#define _mm_srli_epi32 (simde_mm_srli_epi32)
#define _mm_srli_epi64 (simde_mm_srli_epi64)
#define __builtin_ia32_sqrtsd vsqrtq_f64

#define __SSE2__ 1
#include <Eigen/Core>
#undef __SSE2__
