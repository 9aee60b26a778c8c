// Eight pixels to a vector, many vectors under way at once. A step down a tree is a long chain of
// waits: node, probes, comparison. It is cut into two halves, and each half is done for all vectors
// before the next: the processor looks some 300 instructions ahead, and finds there the loads of
// other pixels instead of more of the same chain. That alone is worth half the time.
#include "forest/feature_internal.h"

#if defined(__x86_64__)
#include <immintrin.h>

#include <algorithm>

#define OSSA_AVX2 __attribute__((target("avx2"), always_inline)) inline

namespace ossa::forest {

bool HasAvx2() { return __builtin_cpu_supports("avx2") != 0; }

namespace {

constexpr size_t kLanes = 8;
constexpr size_t kGroups = 16;  // 128 pixels: a tile of ChooseSparse

// Everything about eight pixels under way.
struct Lanes {
  __m256i x, y;  // box coordinates + 1 (ring included)
  __m256 pixels_u, pixels_v;
  __m256i node;
};

// What the first half of a step finds out for the second.
struct Fetched {
  __m256i probe_u, probe_v;  // places in ObjectImage::depth_mm
  __m256i left;
  __m128i threshold_mm;  // 16 bits each
};

struct Box {
  const uint16_t* depth_mm;
  __m256i max_x, max_y, stride;
};

OSSA_AVX2 Box BoxOf(const ObjectImage& image) {
  return {image.depth_mm.data(), _mm256_set1_epi32(image.width + 1),
          _mm256_set1_epi32(image.height + 1), _mm256_set1_epi32(image.stride())};
}

OSSA_AVX2 __m256i SignedLow(__m256i packed) {  // of pairs of 16 bits
  return _mm256_srai_epi32(_mm256_slli_epi32(packed, 16), 16);
}

OSSA_AVX2 __m256i PlaceOf(const Box& box, const Lanes& lanes, __m256i packed_offset) {
  const __m256 offset_u = _mm256_cvtepi32_ps(SignedLow(packed_offset));
  const __m256 offset_v = _mm256_cvtepi32_ps(_mm256_srai_epi32(packed_offset, 16));
  const __m256i du = _mm256_cvtps_epi32(_mm256_mul_ps(offset_u, lanes.pixels_u));
  const __m256i dv = _mm256_cvtps_epi32(_mm256_mul_ps(offset_v, lanes.pixels_v));
  const __m256i zero = _mm256_setzero_si256();
  const __m256i px =
      _mm256_max_epi32(zero, _mm256_min_epi32(box.max_x, _mm256_add_epi32(lanes.x, du)));
  const __m256i py =
      _mm256_max_epi32(zero, _mm256_min_epi32(box.max_y, _mm256_add_epi32(lanes.y, dv)));
  return _mm256_add_epi32(_mm256_mullo_epi32(py, box.stride), px);
}

// Eight depths by single loads: quicker here than a gather, which also reads 32 bits for each 16.
OSSA_AVX2 __m128i ReadDepths(const uint16_t* depth_mm, __m256i place) {
  alignas(32) uint32_t at[kLanes];
  _mm256_store_si256(reinterpret_cast<__m256i*>(at), place);
  __m128i depths = _mm_cvtsi32_si128(depth_mm[at[0]]);
  depths = _mm_insert_epi16(depths, depth_mm[at[1]], 1);
  depths = _mm_insert_epi16(depths, depth_mm[at[2]], 2);
  depths = _mm_insert_epi16(depths, depth_mm[at[3]], 3);
  depths = _mm_insert_epi16(depths, depth_mm[at[4]], 4);
  depths = _mm_insert_epi16(depths, depth_mm[at[5]], 5);
  depths = _mm_insert_epi16(depths, depth_mm[at[6]], 6);
  return _mm_insert_epi16(depths, depth_mm[at[7]], 7);
}

OSSA_AVX2 __m256i LoadPair(const Node* nodes, int a, int b) {
  const __m128i low = _mm_loadu_si128(reinterpret_cast<const __m128i*>(nodes + a));
  const __m128i high = _mm_loadu_si128(reinterpret_cast<const __m128i*>(nodes + b));
  return _mm256_inserti128_si256(_mm256_castsi128_si256(low), high, 1);
}

// Both children stand together: they are on their way before it is known which of them is next.
// Of a leaf nothing is wanted, and a prefetch of no place does no harm.
OSSA_AVX2 void FetchChildren(const Node* nodes, __m256i left) {
  alignas(32) int32_t child[kLanes];
  _mm256_store_si256(reinterpret_cast<__m256i*>(child), left);
  const auto begin = reinterpret_cast<intptr_t>(nodes);
  for (const int32_t i : child) {
    const intptr_t address = begin + static_cast<intptr_t>(i) * static_cast<intptr_t>(sizeof(Node));
    _mm_prefetch(reinterpret_cast<const char*>(address), _MM_HINT_T0);
  }
}

// The first half of a step: eight nodes. Whole 16-byte nodes are loaded and transposed: cheaper
// than gathering their four words.
OSSA_AVX2 Fetched FetchNodes(const Node* nodes, const Box& box, const Lanes& lanes) {
  alignas(32) int index[kLanes];
  _mm256_store_si256(reinterpret_cast<__m256i*>(index), lanes.node);
  const __m256i r0 = LoadPair(nodes, index[0], index[4]);
  const __m256i r1 = LoadPair(nodes, index[1], index[5]);
  const __m256i r2 = LoadPair(nodes, index[2], index[6]);
  const __m256i r3 = LoadPair(nodes, index[3], index[7]);
  const __m256i t0 = _mm256_unpacklo_epi32(r0, r1);
  const __m256i t1 = _mm256_unpacklo_epi32(r2, r3);
  const __m256i t2 = _mm256_unpackhi_epi32(r0, r1);
  const __m256i t3 = _mm256_unpackhi_epi32(r2, r3);
  Fetched fetched;
  fetched.left = _mm256_unpackhi_epi64(t2, t3);
  FetchChildren(nodes, fetched.left);
  const __m256i threshold_mm = SignedLow(_mm256_unpacklo_epi64(t2, t3));
  fetched.threshold_mm = _mm_packs_epi32(_mm256_castsi256_si128(threshold_mm),
                                         _mm256_extracti128_si256(threshold_mm, 1));
  fetched.probe_u = PlaceOf(box, lanes, _mm256_unpacklo_epi64(t0, t1));
  fetched.probe_v = PlaceOf(box, lanes, _mm256_unpackhi_epi64(t0, t1));
  return fetched;
}

// The second half: responses and children; lanes in a leaf stay. Depths are at most
// ForestData::background_mm < 2^15, so that 16 bits hold a response. Returns the mask of lanes
// still walking.
OSSA_AVX2 int StepDown(const Box& box, const Fetched& fetched, Lanes* lanes) {
  const __m128i response_mm = _mm_sub_epi16(ReadDepths(box.depth_mm, fetched.probe_u),
                                            ReadDepths(box.depth_mm, fetched.probe_v));
  const __m256i is_right =
      _mm256_cvtepi16_epi32(_mm_cmpgt_epi16(response_mm, fetched.threshold_mm));
  const __m256i child = _mm256_sub_epi32(fetched.left, is_right);
  const __m256i is_leaf = _mm256_srai_epi32(fetched.left, 31);
  lanes->node = _mm256_blendv_epi8(child, lanes->node, is_leaf);
  return ~_mm256_movemask_ps(_mm256_castsi256_ps(is_leaf)) & 0xff;
}

OSSA_AVX2 Lanes StartLanes(const WalkInput& input, const Box& box, size_t first) {
  alignas(32) int position[kLanes];
  for (size_t i = 0; i < kLanes; ++i) {
    position[i] = input.position[std::min(first + i, input.position.size() - 1)];
  }
  const __m256i one = _mm256_set1_epi32(1);
  const __m256i packed = _mm256_load_si256(reinterpret_cast<const __m256i*>(position));
  Lanes lanes;
  lanes.x = _mm256_add_epi32(_mm256_and_si256(packed, _mm256_set1_epi32(0xffff)), one);
  lanes.y = _mm256_add_epi32(_mm256_srai_epi32(packed, 16), one);
  const __m256i at = _mm256_add_epi32(_mm256_mullo_epi32(lanes.y, box.stride), lanes.x);
  const __m256 d_mm = _mm256_cvtepi32_ps(_mm256_cvtepu16_epi32(ReadDepths(box.depth_mm, at)));
  lanes.pixels_u = _mm256_div_ps(_mm256_set1_ps(input.image->scale_u), d_mm);
  lanes.pixels_v = _mm256_div_ps(_mm256_set1_ps(input.image->scale_v), d_mm);
  lanes.node = _mm256_setzero_si256();
  return lanes;
}

}  // namespace

__attribute__((target("avx2"))) void WalkAvx2(const WalkInput& input, int32_t* leaf,
                                              size_t leaf_stride) {
  const Box box = BoxOf(*input.image);
  for (size_t first = 0; first < input.position.size(); first += kLanes * kGroups) {
    const size_t count = std::min(kLanes * kGroups, input.position.size() - first);
    const size_t groups = (count + kLanes - 1) / kLanes;
    Lanes lanes[kGroups];
    Fetched fetched[kGroups];
    for (size_t g = 0; g < groups; ++g) lanes[g] = StartLanes(input, box, first + kLanes * g);
    for (int walking = 1; walking != 0;) {
      walking = 0;
      for (size_t g = 0; g < groups; ++g) fetched[g] = FetchNodes(input.nodes, box, lanes[g]);
      for (size_t g = 0; g < groups; ++g) walking |= StepDown(box, fetched[g], &lanes[g]);
    }
    alignas(32) int node[kLanes * kGroups];
    for (size_t g = 0; g < groups; ++g) {
      _mm256_store_si256(reinterpret_cast<__m256i*>(node + kLanes * g), lanes[g].node);
    }
    for (size_t i = 0; i < count; ++i) {
      leaf[(first + i) * leaf_stride] = input.nodes[node[i]].leaf();
    }
  }
}

}  // namespace ossa::forest

#else

namespace ossa::forest {

bool HasAvx2() { return false; }
void WalkAvx2(const WalkInput& input, int32_t* leaf, size_t leaf_stride) {
  WalkScalar(input, leaf, leaf_stride);
}

}  // namespace ossa::forest

#endif
