#pragma once
#include <cstddef>
#include <vector>

namespace ossa::depth {

/// A small owning image: row-major, height × width, one value per pixel.
template <typename T>
struct Image {
  int width = 0;
  int height = 0;
  std::vector<T> data;

  Image() = default;
  Image(int w, int h, T fill = T{})
      : width(w), height(h), data(static_cast<size_t>(w) * static_cast<size_t>(h), fill) {}

  T& at(int u, int v) {
    return data[static_cast<size_t>(v) * static_cast<size_t>(width) + static_cast<size_t>(u)];
  }
  const T& at(int u, int v) const {
    return data[static_cast<size_t>(v) * static_cast<size_t>(width) + static_cast<size_t>(u)];
  }
};

}  // namespace ossa::depth
