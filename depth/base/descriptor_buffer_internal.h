#pragma once
#include <array>
#include <cstddef>
#include <ios>
#include <streambuf>

namespace ossa {

/// What a std::ostream writes to an open file, by its descriptor: a std::ofstream opens by name
/// only, and would follow a link that somebody put there meanwhile. Does not own the descriptor.
/// A write that fails loses what was not yet in the file, and the stream is bad.
class DescriptorBuffer final : public std::streambuf {
 public:
  explicit DescriptorBuffer(int descriptor);

  /// Forgets what was not yet written.
  void Discard();

 protected:
  int_type overflow(int_type c) override;
  int sync() override;
  pos_type seekoff(off_type offset, std::ios::seekdir from, std::ios::openmode which) override;
  pos_type seekpos(pos_type place, std::ios::openmode which) override;

 private:
  static constexpr size_t kBytes = size_t{1} << 16;  // a system call for so many; by hand
  std::array<char, kBytes> bytes_;
  int descriptor_;
};

}  // namespace ossa
