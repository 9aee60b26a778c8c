#include "forest/feature_internal.h"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include <algorithm>

namespace ossa::forest {

ObjectImage CutOut(const depth::DepthView& depth, const depth::Camera& camera,
                   std::span<const int32_t> pixels, uint16_t background_mm) {
  ObjectImage image;
  image.scale_u = OffsetScale(camera.fx);
  image.scale_v = OffsetScale(camera.fy);
  int u1 = -1;
  image.u0 = depth.width;
  image.v0 = pixels.empty() ? 0 : pixels.front() / depth.width;
  const int v1 = pixels.empty() ? -1 : pixels.back() / depth.width;
  int32_t row_begin = image.v0 * depth.width;  // pixels ascend: no division
  for (const int32_t pixel : pixels) {
    while (pixel >= row_begin + depth.width) row_begin += depth.width;
    image.u0 = std::min(image.u0, pixel - row_begin);
    u1 = std::max(u1, pixel - row_begin);
  }
  image.width = std::max(0, u1 - image.u0 + 1);
  image.height = v1 - image.v0 + 1;
  image.depth_mm.assign(
      static_cast<size_t>(image.stride()) * static_cast<size_t>(image.height + 2) + 2,
      background_mm);
  int v = image.v0;
  row_begin = image.v0 * depth.width;
  for (const int32_t pixel : pixels) {
    for (; pixel >= row_begin + depth.width; row_begin += depth.width) ++v;
    const int u = pixel - row_begin;
    const uint16_t mm = depth.at(u, v);
    if (mm != 0) image.depth_mm[image.At(u - image.u0, v - image.v0)] = std::min(mm, background_mm);
  }
  return image;
}

void WalkScalar(const WalkInput& input, int32_t* leaf, size_t leaf_stride) {
  const ObjectImage& image = *input.image;
  const uint16_t* depth_mm = image.depth_mm.data();
  for (size_t i = 0; i < input.position.size(); ++i) {
    const int x = input.position[i] & 0xffff;
    const int y = input.position[i] >> 16;
    const auto d_mm = static_cast<float>(depth_mm[image.At(x, y)]);
    const float pixels_u = image.scale_u / d_mm;
    const float pixels_v = image.scale_v / d_mm;
    const Node* node = input.nodes;
    while (!node->is_leaf()) {
      const auto read = [&](const std::array<int16_t, 2>& offset) {
        return static_cast<int>(
            depth_mm[static_cast<size_t>(ProbeIndex(x, y, offset[0], offset[1], pixels_u, pixels_v,
                                                    image.width, image.height, image.stride()))]);
      };
      const int response_mm = read(node->u) - read(node->v);
      node = input.nodes + node->left + (response_mm > node->threshold_mm ? 1 : 0);
    }
    leaf[i * leaf_stride] = node->leaf();
  }
}

#if defined(__x86_64__)

bool HasAvx2() { return __builtin_cpu_supports("avx2") != 0; }

namespace {

// Everything about eight pixels under way.
struct Lanes {
  __m256i x, y;  // box coordinates + 1 (ring included)
  __m256 pixels_u, pixels_v;
  __m256i node;
};

struct Box {
  const int* depth;  // read as 32 bits at 16-bit steps
  __m256i max_x, max_y, stride;
};

__attribute__((target("avx2"), always_inline)) inline __m256i ReadProbe(const Box& box,
                                                                        const Lanes& lanes,
                                                                        __m256i packed_offset) {
  const __m256i offset_u = _mm256_srai_epi32(_mm256_slli_epi32(packed_offset, 16), 16);
  const __m256i offset_v = _mm256_srai_epi32(packed_offset, 16);
  const __m256i du =
      _mm256_cvtps_epi32(_mm256_mul_ps(_mm256_cvtepi32_ps(offset_u), lanes.pixels_u));
  const __m256i dv =
      _mm256_cvtps_epi32(_mm256_mul_ps(_mm256_cvtepi32_ps(offset_v), lanes.pixels_v));
  const __m256i zero = _mm256_setzero_si256();
  const __m256i px =
      _mm256_max_epi32(zero, _mm256_min_epi32(box.max_x, _mm256_add_epi32(lanes.x, du)));
  const __m256i py =
      _mm256_max_epi32(zero, _mm256_min_epi32(box.max_y, _mm256_add_epi32(lanes.y, dv)));
  const __m256i index = _mm256_add_epi32(_mm256_mullo_epi32(py, box.stride), px);
  return _mm256_and_si256(_mm256_i32gather_epi32(box.depth, index, 2), _mm256_set1_epi32(0xffff));
}

__attribute__((target("avx2"), always_inline)) inline __m256i LoadPair(const Node* nodes, int a,
                                                                       int b) {
  const __m128i low = _mm_loadu_si128(reinterpret_cast<const __m128i*>(nodes + a));
  const __m128i high = _mm_loadu_si128(reinterpret_cast<const __m128i*>(nodes + b));
  return _mm256_inserti128_si256(_mm256_castsi128_si256(low), high, 1);
}

// One step down for eight pixels; lanes in a leaf stay. Returns the mask of lanes still walking.
// Whole 16-byte nodes are loaded and transposed: cheaper than gathering their four words.
__attribute__((target("avx2"), always_inline)) inline int StepDown(const Node* nodes,
                                                                   const Box& box, Lanes* lanes) {
  alignas(32) int index[8];
  _mm256_store_si256(reinterpret_cast<__m256i*>(index), lanes->node);
  const __m256i r0 = LoadPair(nodes, index[0], index[4]);
  const __m256i r1 = LoadPair(nodes, index[1], index[5]);
  const __m256i r2 = LoadPair(nodes, index[2], index[6]);
  const __m256i r3 = LoadPair(nodes, index[3], index[7]);
  const __m256i t0 = _mm256_unpacklo_epi32(r0, r1);
  const __m256i t1 = _mm256_unpacklo_epi32(r2, r3);
  const __m256i t2 = _mm256_unpackhi_epi32(r0, r1);
  const __m256i t3 = _mm256_unpackhi_epi32(r2, r3);
  const __m256i offset_u = _mm256_unpacklo_epi64(t0, t1);
  const __m256i offset_v = _mm256_unpackhi_epi64(t0, t1);
  const __m256i packed_threshold = _mm256_unpacklo_epi64(t2, t3);
  const __m256i left = _mm256_unpackhi_epi64(t2, t3);
  // Both children stand together: they are on their way before it is known which of them is next.
  alignas(32) int child_index[8];
  _mm256_store_si256(reinterpret_cast<__m256i*>(child_index), left);
  for (const int i : child_index) {
    _mm_prefetch(reinterpret_cast<const char*>(nodes + std::max(i, 0)), _MM_HINT_T0);
  }
  const __m256i response =
      _mm256_sub_epi32(ReadProbe(box, *lanes, offset_u), ReadProbe(box, *lanes, offset_v));
  const __m256i threshold = _mm256_srai_epi32(_mm256_slli_epi32(packed_threshold, 16), 16);
  const __m256i is_right = _mm256_cmpgt_epi32(response, threshold);
  const __m256i child = _mm256_sub_epi32(left, is_right);
  lanes->node = _mm256_blendv_epi8(child, lanes->node, _mm256_srai_epi32(left, 31));
  return ~_mm256_movemask_ps(_mm256_castsi256_ps(left)) & 0xff;
}

__attribute__((target("avx2"), always_inline)) inline Lanes StartLanes(const WalkInput& input,
                                                                       const Box& box,
                                                                       size_t first) {
  alignas(32) int position[8];
  for (size_t i = 0; i < 8; ++i) {
    position[i] = input.position[std::min(first + i, input.position.size() - 1)];
  }
  const __m256i one = _mm256_set1_epi32(1);
  const __m256i packed = _mm256_load_si256(reinterpret_cast<const __m256i*>(position));
  Lanes lanes;
  lanes.x = _mm256_add_epi32(_mm256_and_si256(packed, _mm256_set1_epi32(0xffff)), one);
  lanes.y = _mm256_add_epi32(_mm256_srai_epi32(packed, 16), one);
  const __m256i at = _mm256_add_epi32(_mm256_mullo_epi32(lanes.y, box.stride), lanes.x);
  const __m256i d_mm =
      _mm256_and_si256(_mm256_i32gather_epi32(box.depth, at, 2), _mm256_set1_epi32(0xffff));
  const __m256 d = _mm256_cvtepi32_ps(d_mm);
  lanes.pixels_u = _mm256_div_ps(_mm256_set1_ps(input.image->scale_u), d);
  lanes.pixels_v = _mm256_div_ps(_mm256_set1_ps(input.image->scale_v), d);
  lanes.node = _mm256_setzero_si256();
  return lanes;
}

}  // namespace

__attribute__((target("avx2"))) void WalkAvx2(const WalkInput& input, int32_t* leaf,
                                              size_t leaf_stride) {
  constexpr size_t kGroups = 4;  // 4 × 8 pixels hide each other's cache misses
  const ObjectImage& image = *input.image;
  const Box box{reinterpret_cast<const int*>(image.depth_mm.data()),
                _mm256_set1_epi32(image.width + 1), _mm256_set1_epi32(image.height + 1),
                _mm256_set1_epi32(image.stride())};
  for (size_t first = 0; first < input.position.size(); first += 8 * kGroups) {
    Lanes lanes[kGroups];
    for (size_t g = 0; g < kGroups; ++g) lanes[g] = StartLanes(input, box, first + 8 * g);
    int walking = 1;
    while (walking != 0) {
      walking = 0;
      for (size_t g = 0; g < kGroups; ++g) walking |= StepDown(input.nodes, box, &lanes[g]);
    }
    const size_t count = std::min(8 * kGroups, input.position.size() - first);
    alignas(32) int node[8 * kGroups];
    for (size_t g = 0; g < kGroups; ++g) {
      _mm256_store_si256(reinterpret_cast<__m256i*>(node + 8 * g), lanes[g].node);
    }
    for (size_t i = 0; i < count; ++i) {
      leaf[(first + i) * leaf_stride] = input.nodes[node[i]].leaf();
    }
  }
}

#else

bool HasAvx2() { return false; }
void WalkAvx2(const WalkInput& input, int32_t* leaf, size_t leaf_stride) {
  WalkScalar(input, leaf, leaf_stride);
}

#endif

void Walk(const WalkInput& input, int32_t* leaf, size_t leaf_stride) {
  static const bool has_avx2 = HasAvx2();
  (has_avx2 ? WalkAvx2 : WalkScalar)(input, leaf, leaf_stride);
}

}  // namespace ossa::forest
