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
constexpr int kCachedLevels = 9;

// Everything about eight pixels under way. Pairs of 16 bits are (u, v) or (x, y), as in Node: no
// image is larger than 2^15 a side.
struct Lanes {
  __m256i place;  // box coordinates + 1 (ring included), in pairs
  __m256i scale;  // FixedScale, in pairs
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
  __m256i most;     // coordinates, ring included, in pairs
  __m256i strides;  // (1, stride) in pairs
};

OSSA_AVX2 __m256i Pairs(int low, int high) { return _mm256_set1_epi32((high << 16) | low); }

OSSA_AVX2 Box BoxOf(const ObjectImage& image) {
  return {image.depth_mm.data(), Pairs(image.width + 1, image.height + 1),
          Pairs(1, image.stride())};
}

// ScaleOffset, clamping and the place's number, for x and y together.
OSSA_AVX2 __m256i PlaceOf(const Box& box, const Lanes& lanes, __m256i offset) {
  const __m256i at = _mm256_adds_epi16(lanes.place, _mm256_mulhrs_epi16(offset, lanes.scale));
  const __m256i inside = _mm256_max_epi16(_mm256_setzero_si256(), _mm256_min_epi16(box.most, at));
  return _mm256_madd_epi16(inside, box.strides);
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

OSSA_AVX2 const char* At(const Node* nodes, int32_t byte) {
  return reinterpret_cast<const char*>(nodes) + byte;
}

OSSA_AVX2 __m256i LoadPair(const Node* nodes, int32_t byte_a, int32_t byte_b) {
  const __m128i low = _mm_loadu_si128(reinterpret_cast<const __m128i*>(At(nodes, byte_a)));
  const __m128i high = _mm_loadu_si128(reinterpret_cast<const __m128i*>(At(nodes, byte_b)));
  return _mm256_inserti128_si256(_mm256_castsi128_si256(low), high, 1);
}

OSSA_AVX2 __m256i BytesOf(__m256i nodes) { return _mm256_slli_epi32(nodes, 4); }
static_assert(sizeof(Node) == 1 << 4);

// Both children stand together: they are on their way before it is known which of them is next.
// Of a leaf nothing is wanted, and a prefetch of no place does no harm.
OSSA_AVX2 void FetchChildren(const Node* nodes, __m256i left) {
  alignas(32) int32_t byte[kLanes];
  _mm256_store_si256(reinterpret_cast<__m256i*>(byte), BytesOf(left));
  const auto begin = reinterpret_cast<intptr_t>(nodes);
  for (const int32_t b : byte) {
    _mm_prefetch(reinterpret_cast<const char*>(begin + b), _MM_HINT_T0);
  }
}

OSSA_AVX2 __m128i LowHalves(__m256i pairs) {
  constexpr int kNone = -1;
  const __m256i low = _mm256_setr_epi8(0, 1, 4, 5, 8, 9, 12, 13, kNone, kNone, kNone, kNone, kNone,
                                       kNone, kNone, kNone, 0, 1, 4, 5, 8, 9, 12, 13, kNone, kNone,
                                       kNone, kNone, kNone, kNone, kNone, kNone);
  const __m256i packed = _mm256_permute4x64_epi64(_mm256_shuffle_epi8(pairs, low), 0x08);
  return _mm256_castsi256_si128(packed);
}

// The first half of a step: eight nodes. Whole 16-byte nodes are loaded and transposed: cheaper
// than gathering their four words.
template <bool kFetchChildren>
OSSA_AVX2 Fetched FetchNodes(const Node* nodes, const Box& box, const Lanes& lanes) {
  alignas(32) int32_t byte[kLanes];
  _mm256_store_si256(reinterpret_cast<__m256i*>(byte), BytesOf(lanes.node));
  const __m256i r0 = LoadPair(nodes, byte[0], byte[4]);
  const __m256i r1 = LoadPair(nodes, byte[1], byte[5]);
  const __m256i r2 = LoadPair(nodes, byte[2], byte[6]);
  const __m256i r3 = LoadPair(nodes, byte[3], byte[7]);
  const __m256i t0 = _mm256_unpacklo_epi32(r0, r1);
  const __m256i t1 = _mm256_unpacklo_epi32(r2, r3);
  const __m256i t2 = _mm256_unpackhi_epi32(r0, r1);
  const __m256i t3 = _mm256_unpackhi_epi32(r2, r3);
  Fetched fetched;
  fetched.left = _mm256_unpackhi_epi64(t2, t3);
  if (kFetchChildren) FetchChildren(nodes, fetched.left);
  fetched.threshold_mm = LowHalves(_mm256_unpacklo_epi64(t2, t3));
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

OSSA_AVX2 __m256i FixedScales(float scale, __m256 d_mm) {
  const __m256 fixed = _mm256_div_ps(_mm256_set1_ps(scale * 32768.0F), d_mm);
  return _mm256_cvtps_epi32(_mm256_min_ps(fixed, _mm256_set1_ps(32767.0F)));
}

OSSA_AVX2 Lanes StartLanes(const WalkInput& input, const Box& box, size_t first) {
  alignas(32) int position[kLanes];
  for (size_t i = 0; i < kLanes; ++i) {
    position[i] = input.position[std::min(first + i, input.position.size() - 1)];
  }
  Lanes lanes;
  lanes.place =
      _mm256_add_epi32(_mm256_load_si256(reinterpret_cast<const __m256i*>(position)), Pairs(1, 1));
  const __m256i at = _mm256_madd_epi16(lanes.place, box.strides);
  const __m256 d_mm = _mm256_cvtepi32_ps(_mm256_cvtepu16_epi32(ReadDepths(box.depth_mm, at)));
  lanes.scale = _mm256_or_si256(FixedScales(input.image->scale_u, d_mm),
                                _mm256_slli_epi32(FixedScales(input.image->scale_v, d_mm), 16));
  lanes.node = _mm256_setzero_si256();
  return lanes;
}

// One level down for all groups; says whether any lane still walks.
template <bool kFetchChildren>
OSSA_AVX2 bool StepAll(const WalkInput& input, const Box& box, size_t groups, Lanes* lanes) {
  Fetched fetched[kGroups];
  for (size_t g = 0; g < groups; ++g) {
    fetched[g] = FetchNodes<kFetchChildren>(input.nodes, box, lanes[g]);
  }
  int walking = 0;
  for (size_t g = 0; g < groups; ++g) walking |= StepDown(box, fetched[g], &lanes[g]);
  return walking != 0;
}

}  // namespace

__attribute__((target("avx2"))) void WalkAvx2(const WalkInput& input, int32_t* leaf,
                                              size_t leaf_stride) {
  const Box box = BoxOf(*input.image);
  for (size_t first = 0; first < input.position.size(); first += kLanes * kGroups) {
    const size_t count = std::min(kLanes * kGroups, input.position.size() - first);
    const size_t groups = (count + kLanes - 1) / kLanes;
    Lanes lanes[kGroups];
    for (size_t g = 0; g < groups; ++g) lanes[g] = StartLanes(input, box, first + kLanes * g);
    bool walking = true;
    // The uppermost levels are always in the cache.
    for (int level = 0; walking && level < kCachedLevels; ++level) {
      walking = StepAll<false>(input, box, groups, lanes);
    }
    while (walking) walking = StepAll<true>(input, box, groups, lanes);
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
