#pragma once
#include <filesystem>
#include <new>
#include <stdexcept>

#include "depth/base/error.h"

namespace ossa {

/// Returns the result of `read`; throws InputError that names the file if memory runs out: a user
/// of many files has to know which is too large.
template <typename Read>
auto NamingTheFile(const std::filesystem::path& file, const Read& read) -> decltype(read()) {
  try {
    return read();
  } catch (const std::bad_alloc&) {
    throw InputError(file.string() + ": out of memory: expected a file that fits into it");
  } catch (const std::length_error&) {  // larger than the address space
    throw InputError(file.string() + ": out of memory: expected a file that fits into it");
  }
}

}  // namespace ossa
