// Eight pixels per vector, many vectors interleaved. A step down a tree is a long dependency chain:
// node, probes, comparison. It is split into two halves, each of which is executed for all vectors
// before the next. The processor looks some 300 instructions ahead, and so finds independent loads
// of other pixels. That alone halves the time.
#include "forest/trees/depth_feature_internal.h"

#if defined(__x86_64__)
#include <immintrin.h>

#include <algorithm>
#include <cstddef>

#define OSSA_AVX2 __attribute__((target("avx2"), always_inline)) inline

namespace ossa::forest {

namespace {

// Constants: of AVX2 registers and cache lines.

constexpr size_t kLanes = 8;
constexpr size_t kGroups = 16;  // 128 pixels: the tile size of ChooseSparse
constexpr int kCachedLines = 3;

// State of eight pixels. Pairs of 16 bits are (u, v) or (x, y), as in Node: images are at most 2^15
// per side.
struct Lanes {
  __m256i place;  // box coordinates + 1 (ring included), in pairs
  __m256i scale;  // FixedScale, in pairs
  __m256i node;   // byte offset in the tree's lines
  __m256i leaf;   // negative: still walking
};

// Results of the first half of a step.
struct Fetched {
  __m256i probe_u, probe_v;  // indices into ObjectImage::depth_mm
  __m256i threshold_mm;
};

struct Box {
  const uint16_t* depth_mm;
  __m256i most;     // coordinates, ring included, in pairs
  __m256i strides;  // (1, stride) in pairs
};

struct Lines {
  const char* begin;
  __m256i offset_step;  // 16 bits each
};

OSSA_AVX2 __m256i Pairs(int low, int high) { return _mm256_set1_epi32((high << 16) | low); }

OSSA_AVX2 Box MakeBox(const ObjectImage& image) {
  return {image.depth_mm.data(), Pairs(image.width + 1, image.height + 1),
          Pairs(1, image.stride())};
}

// ScaleOffset, clamping and the index, for x and y together.
OSSA_AVX2 __m256i PlaceOf(const Box& box, const Lanes& lanes, __m256i offset) {
  const __m256i at = _mm256_adds_epi16(lanes.place, _mm256_mulhrs_epi16(offset, lanes.scale));
  const __m256i inside = _mm256_max_epi16(_mm256_setzero_si256(), _mm256_min_epi16(box.most, at));
  return _mm256_madd_epi16(inside, box.strides);
}

// Eight scalar loads: faster here than a gather, which also reads 32 bits for each 16.
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

OSSA_AVX2 __m256i Splat(int value) { return _mm256_set1_epi32(value); }

// Loads two times 64 bits.
OSSA_AVX2 __m128i LoadTwo(const char* begin, int32_t byte_a, int32_t byte_b) {
  const __m128i a = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(begin + byte_a));
  const __m128i b = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(begin + byte_b));
  return _mm_unpacklo_epi64(a, b);
}

// The lower and upper halves of eight 64-bit nodes.
struct Halves {
  __m256i low, high;
};
OSSA_AVX2 Halves LoadHalves(const char* begin, __m256i bytes) {
  alignas(32) int32_t byte[kLanes];
  _mm256_store_si256(reinterpret_cast<__m256i*>(byte), bytes);
  const __m256i even =
      _mm256_set_m128i(LoadTwo(begin, byte[4], byte[5]), LoadTwo(begin, byte[0], byte[1]));
  const __m256i odd =
      _mm256_set_m128i(LoadTwo(begin, byte[6], byte[7]), LoadTwo(begin, byte[2], byte[3]));
  const __m256 a = _mm256_castsi256_ps(even);
  const __m256 b = _mm256_castsi256_ps(odd);
  return {_mm256_castps_si256(_mm256_shuffle_ps(a, b, 0x88)),
          _mm256_castps_si256(_mm256_shuffle_ps(a, b, 0xdd))};
}

OSSA_AVX2 __m256i UnpackOffsets(__m256i words, __m256i offset_step) {
  return _mm256_mullo_epi16(_mm256_srai_epi16(words, 4), offset_step);
}

// Assembles each lane's threshold from its four parts.
OSSA_AVX2 __m256i UnpackThresholds(const Halves& nodes) {
  const __m256i pieces = Pairs(15, 15);
  const __m256i u = _mm256_and_si256(nodes.low, pieces);
  const __m256i v = _mm256_and_si256(nodes.high, pieces);
  const __m256i bytes = _mm256_or_si256(u, _mm256_slli_epi32(v, 4));
  const __m256i whole = _mm256_or_si256(bytes, _mm256_srli_epi32(bytes, 8));
  return _mm256_srai_epi32(_mm256_slli_epi32(whole, 16), 16);
}

// The first half of a step: eight nodes.
OSSA_AVX2 Fetched FetchNodes(const Lines& lines, const Box& box, const Lanes& lanes) {
  const Halves nodes = LoadHalves(lines.begin, lanes.node);
  return {PlaceOf(box, lanes, UnpackOffsets(nodes.low, lines.offset_step)),
          PlaceOf(box, lanes, UnpackOffsets(nodes.high, lines.offset_step)),
          UnpackThresholds(nodes)};
}

// The second half: -1 in lanes that go right. Depths are at most ForestData::background_mm < 2^15,
// so responses fit into 16 bits.
OSSA_AVX2 __m256i GoesRight(const Box& box, const Fetched& fetched) {
  const __m128i response_mm = _mm_sub_epi16(ReadDepths(box.depth_mm, fetched.probe_u),
                                            ReadDepths(box.depth_mm, fetched.probe_v));
  return _mm256_cmpgt_epi32(_mm256_cvtepi16_epi32(response_mm), fetched.threshold_mm);
}

// From node i of a line to node 2 i + 1 or 2 i + 2.
OSSA_AVX2 void StepWithin(__m256i is_right, Lanes* lanes) {
  const __m256i in_line = _mm256_and_si256(lanes->node, Splat(sizeof(NodeLine) - 1));
  const __m256i child = _mm256_sub_epi32(Splat(8), _mm256_slli_epi32(is_right, 3));
  lanes->node = _mm256_add_epi32(_mm256_add_epi32(lanes->node, in_line), child);
}

// Population count of each byte.
OSSA_AVX2 __m256i CountBits(__m256i bytes) {
  const __m256i of_nibble = _mm256_setr_epi8(0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4, 0, 1,
                                             1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4);
  const __m256i nibble = _mm256_set1_epi8(15);
  const __m256i low = _mm256_and_si256(bytes, nibble);
  const __m256i high = _mm256_and_si256(_mm256_srli_epi16(bytes, 4), nibble);
  return _mm256_add_epi8(_mm256_shuffle_epi8(of_nibble, low), _mm256_shuffle_epi8(of_nibble, high));
}

// Leaves a line for the next one, or for a leaf; lanes in a leaf keep walking in the first line, so
// that all lanes execute the same code. The number of earlier exits of the same kind selects the
// line or leaf.
OSSA_AVX2 void StepOut(const Lines& lines, __m256i is_right, Lanes* lanes) {
  constexpr int kLowestNodes = 3 * sizeof(PackedNode);
  static_assert(offsetof(NodeLine, lines) % 8 == 0);
  const __m256i in_line = _mm256_and_si256(lanes->node, Splat(sizeof(NodeLine) - 1));
  const __m256i left = _mm256_srli_epi32(_mm256_sub_epi32(in_line, Splat(kLowestNodes)), 2);
  const __m256i way = _mm256_sllv_epi32(Splat(1), _mm256_sub_epi32(left, is_right));
  const __m256i before = _mm256_sub_epi32(way, Splat(1));
  const Halves ways =
      LoadHalves(lines.begin + offsetof(NodeLine, lines), _mm256_sub_epi32(lanes->node, in_line));
  const __m256i lines_before = _mm256_and_si256(ways.low, before);
  const __m256i leaves_before = _mm256_and_si256(ways.high, before);
  const __m256i count =
      CountBits(_mm256_or_si256(lines_before, _mm256_slli_epi32(leaves_before, 8)));
  const __m256i line =
      _mm256_add_epi32(_mm256_srli_epi32(ways.low, 8), _mm256_and_si256(count, Splat(255)));
  const __m256i leaf =
      _mm256_add_epi32(_mm256_srli_epi32(ways.high, 8), _mm256_srli_epi32(count, 8));
  const __m256i goes_on = _mm256_cmpeq_epi32(_mm256_and_si256(ways.low, way), way);
  lanes->node = _mm256_and_si256(_mm256_slli_epi32(line, 6), goes_on);
  const __m256i arrives = _mm256_andnot_si256(goes_on, _mm256_srai_epi32(lanes->leaf, 31));
  lanes->leaf = _mm256_blendv_epi8(lanes->leaf, leaf, arrives);
}

// Prefetches the whole line as soon as it is known.
OSSA_AVX2 void FetchLines(const Lines& lines, __m256i bytes) {
  alignas(32) int32_t byte[kLanes];
  _mm256_store_si256(reinterpret_cast<__m256i*>(byte), bytes);
  for (const int32_t b : byte) _mm_prefetch(lines.begin + b, _MM_HINT_T0);
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
  lanes.node = Splat(input.tree->first_node * static_cast<int>(sizeof(PackedNode)));
  lanes.leaf = Splat(-1);
  return lanes;
}

// One level down for all groups, within their lines.
OSSA_AVX2 void StepAllWithin(const Lines& lines, const Box& box, size_t groups, Lanes* lanes) {
  Fetched fetched[kGroups];
  for (size_t g = 0; g < groups; ++g) fetched[g] = FetchNodes(lines, box, lanes[g]);
  for (size_t g = 0; g < groups; ++g) StepWithin(GoesRight(box, fetched[g]), &lanes[g]);
}

// One level down for all groups, into the next line; returns whether any lane is still walking.
template <bool kFetchLines>
OSSA_AVX2 bool StepAllOut(const Lines& lines, const Box& box, size_t groups, Lanes* lanes) {
  Fetched fetched[kGroups];
  for (size_t g = 0; g < groups; ++g) fetched[g] = FetchNodes(lines, box, lanes[g]);
  __m256i walking = _mm256_setzero_si256();
  for (size_t g = 0; g < groups; ++g) {
    StepOut(lines, GoesRight(box, fetched[g]), &lanes[g]);
    if (kFetchLines) FetchLines(lines, lanes[g].node);
    walking = _mm256_or_si256(walking, lanes[g].leaf);
  }
  return _mm256_movemask_ps(_mm256_castsi256_ps(walking)) != 0;
}

// Walks all groups to their leaves.
OSSA_AVX2 void WalkAll(const WalkInput& input, const Box& box, size_t groups, Lanes* lanes) {
  const LinedTree& tree = *input.tree;
  const Lines lines{reinterpret_cast<const char*>(tree.lines.data()),
                    _mm256_set1_epi16(static_cast<int16_t>(tree.offset_step))};
  int steps_within = tree.first_node == 0 ? 2 : tree.first_node == 1 ? 1 : 0;
  bool walking = true;
  for (int line = 0; walking; ++line, steps_within = 2) {
    for (int step = 0; step < steps_within; ++step) StepAllWithin(lines, box, groups, lanes);
    // The top lines are always cached.
    walking = line < kCachedLines ? StepAllOut<false>(lines, box, groups, lanes)
                                  : StepAllOut<true>(lines, box, groups, lanes);
  }
}

}  // namespace

__attribute__((target("avx2"))) void WalkAvx2(const WalkInput& input, int32_t* leaf,
                                              size_t leaf_stride) {
  const Box box = MakeBox(*input.image);
  for (size_t first = 0; first < input.position.size(); first += kLanes * kGroups) {
    const size_t count = std::min(kLanes * kGroups, input.position.size() - first);
    const size_t groups = (count + kLanes - 1) / kLanes;
    Lanes lanes[kGroups];
    for (size_t g = 0; g < groups; ++g) lanes[g] = StartLanes(input, box, first + kLanes * g);
    WalkAll(input, box, groups, lanes);
    alignas(32) int32_t ends[kLanes * kGroups];
    for (size_t g = 0; g < groups; ++g) {
      _mm256_store_si256(reinterpret_cast<__m256i*>(ends + kLanes * g), lanes[g].leaf);
    }
    for (size_t i = 0; i < count; ++i) leaf[(first + i) * leaf_stride] = ends[i];
  }
}

}  // namespace ossa::forest

#else

namespace ossa::forest {

void WalkAvx2(const WalkInput& input, int32_t* leaf, size_t leaf_stride) {
  WalkScalar(input, leaf, leaf_stride);
}

}  // namespace ossa::forest

#endif
