#pragma once
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "depth/base/checksummed_container.h"
#include "forest/trees/tree.h"

namespace ossa::forest {

/// One tree in the format of model files since version 3: compressible byte columns.
void PutTree(PayloadWriter* writer, const Tree& tree);
Tree GetTree(PayloadReader* reader);
/// Skips a tree without validating it; GetTree validates.
void SkipTree(PayloadReader* reader);
/// The format of versions 1 and 2.
Tree GetTreeOfVersion2(PayloadReader* reader);

/// Byte planes: all first bytes, then all second bytes, and so on, which compress better.
template <typename T>
void PutPlanes(PayloadWriter* writer, const std::vector<T>& values) {
  std::vector<uint8_t> plane(values.size());
  const auto* bytes = reinterpret_cast<const uint8_t*>(values.data());
  for (size_t b = 0; b < sizeof(T); ++b) {
    for (size_t i = 0; i < plane.size(); ++i) plane[i] = bytes[i * sizeof(T) + b];
    writer->PutVector(plane);
  }
}

template <typename T>
std::vector<T> GetPlanes(PayloadReader* reader, std::string_view field) {
  std::vector<T> values;
  for (size_t b = 0; b < sizeof(T); ++b) {
    const std::span<const uint8_t> plane = reader->GetBytes(field);
    if (b == 0) values.resize(plane.size());
    if (plane.size() != values.size()) reader->Fail(field, "uneven planes of bytes");
    auto* bytes = reinterpret_cast<uint8_t*>(values.data());
    for (size_t i = 0; i < plane.size(); ++i) bytes[i * sizeof(T) + b] = plane[i];
  }
  return values;
}

}  // namespace ossa::forest
