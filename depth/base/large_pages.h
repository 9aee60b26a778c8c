#pragma once
#include <cstddef>
#include <vector>

namespace ossa {

/// Asks the system to keep this memory in pages of 2 MB, as far as whole ones fit into it: of
/// tables that are read at random places most reads would else miss the translation cache first. A
/// wish: where the system refuses, all is as good but slower.
void PreferLargePages(const void* memory, size_t bytes);

/// All zero, in such pages from the beginning: one page is cleared faster than 512 small ones are
/// asked for.
template <typename T>
std::vector<T> MakeLargeVector(size_t count) {
  std::vector<T> numbers;
  numbers.reserve(count);
  PreferLargePages(numbers.data(), count * sizeof(T));
  numbers.resize(count);
  return numbers;
}

/// Gives memory that was freed back to the system, before something large needs other memory: what
/// a file was read through would else be counted with what stays. A wish, too.
void ReturnFreedMemory();

}  // namespace ossa
