#pragma once
#include <cstdint>
#include <cstring>
#include <vector>

namespace ossa::test {

/// The bytes of a frame of bodies as Kinect Studio records it, without people.
class XefBodies {
 public:
  /// Joint j at (x, j / 100, 2) metres, the 12th (HandRight) inferred; the feet without
  /// orientation.
  XefBodies& Set(size_t body, uint64_t id, float x) {
    const size_t begin = 32 + 1040 * body;
    for (uint32_t j = 0; j < 25; ++j) {
      const bool is_foot = j == 15 || j == 19;
      Put(begin + 16 * j, x);
      Put(begin + 16 * j + 4, 0.01F * static_cast<float>(j));
      Put(begin + 16 * j + 8, 2.0F);
      Put(begin + 400 + 16 * j + 12, is_foot ? 0.0F : 1.0F);
      Put(begin + 800 + 4 * j, j == 11 ? 1 : 2);
    }
    Put(begin + 1008, id);
    Put(begin + 1016, 1);
    return *this;
  }
  const std::vector<uint8_t>& bytes() const { return bytes_; }

 private:
  template <typename T>
  void Put(size_t at, T number) {
    std::memcpy(&bytes_[at], &number, sizeof(T));
  }
  std::vector<uint8_t> bytes_ = std::vector<uint8_t>(6288);
};

}  // namespace ossa::test
