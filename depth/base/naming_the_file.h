#pragma once
#include <filesystem>
#include <new>
#include <stdexcept>

#include "depth/base/error.h"

namespace ossa {

/// What `read` returns of the file; throws InputError that names it when memory runs out meanwhile:
/// of a program's many files the user has to know which is too large.
template <typename Read>
auto NamingTheFile(const std::filesystem::path& file, const Read& read) -> decltype(read()) {
  try {
    return read();
  } catch (const std::bad_alloc&) {
    throw InputError(file.string() + ": out of memory: expected a file that fits into it");
  } catch (const std::length_error&) {  // more than any memory holds
    throw InputError(file.string() + ": out of memory: expected a file that fits into it");
  }
}

}  // namespace ossa
