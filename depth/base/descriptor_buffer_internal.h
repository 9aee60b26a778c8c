#pragma once
#include <array>
#include <cstddef>
#include <ios>
#include <streambuf>

namespace ossa {

/// Stream buffer of a std::ostream that writes to an open file descriptor. A std::ofstream opens by
/// name and would follow a link that was put there meanwhile. Does not own the descriptor. If a
/// write fails, the buffered bytes are lost and the stream is bad.
class DescriptorBuffer final : public std::streambuf {
 public:
  explicit DescriptorBuffer(int descriptor);

  /// Discards the buffered bytes.
  void Discard();

 protected:
  int_type overflow(int_type c) override;
  int sync() override;
  pos_type seekoff(off_type offset, std::ios::seekdir from, std::ios::openmode which) override;
  pos_type seekpos(pos_type place, std::ios::openmode which) override;

 private:
  static constexpr size_t kBytes = size_t{1} << 16;  // buffer size, one system call each; by hand
  std::array<char, kBytes> bytes_;
  int descriptor_;
};

}  // namespace ossa
