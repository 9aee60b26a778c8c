#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <stdexcept>
#include <string>

#include "ossa/ossa_c.h"

/// What the files behind ossa_c.h share.
namespace ossa::tracker {

/// The one thing a C caller cannot be handed otherwise: why its thread's last call failed.
std::string& LastError();

/// Runs `call`, which returns an ossa_status; what it throws becomes OSSA_FAILED and LastError.
template <typename Call>
ossa_status Guarded(const Call& call) {
  try {
    return call();
  } catch (const std::exception& error) {
    LastError() = error.what();
  } catch (...) {
    LastError() = "unknown failure";
  }
  return OSSA_FAILED;
}

inline void RequireNotNull(const void* pointer, const char* call, const char* what) {
  if (pointer != nullptr) return;
  throw std::invalid_argument(std::string(call) + ": expected " + what + ", found NULL");
}

/// Throws unless struct_size can be: that of an `earlier` version of the struct (the offset of what
/// was added after it), of this one, or of a later one, which is not so much that it was never set.
/// Structs end without padding, so that a member that is added lies behind what older programs
/// know.
template <typename T>
void CheckSize(const T& given, const char* name, std::initializer_list<size_t> earlier = {}) {
  constexpr size_t kMostAdded = 4096;  // bytes by which later versions may grow, by hand
  if (given.struct_size >= sizeof(T) && given.struct_size <= sizeof(T) + kMostAdded) return;
  if (std::find(earlier.begin(), earlier.end(), given.struct_size) != earlier.end()) return;
  throw std::invalid_argument(std::string(name) + ".struct_size: expected sizeof(" + name + "), " +
                              std::to_string(sizeof(T)) + ", found " +
                              std::to_string(given.struct_size));
}

/// What a caller handed over: members that it was compiled without are 0. Throws where it sets
/// members that this library does not know.
template <typename T>
T ReadStruct(const T& given, const char* name, std::initializer_list<size_t> earlier = {}) {
  CheckSize(given, name, earlier);
  const auto* bytes = reinterpret_cast<const unsigned char*>(&given);
  const bool known =
      given.struct_size <= sizeof(T) || std::all_of(bytes + sizeof(T), bytes + given.struct_size,
                                                    [](unsigned char b) { return b == 0; });
  if (!known) {
    throw std::invalid_argument(std::string(name) + ": a member behind byte " +
                                std::to_string(sizeof(T)) +
                                " is set, which this version of ossa does not know");
  }
  T value{};
  std::memcpy(&value, &given, std::min<size_t>(sizeof(T), given.struct_size));
  return value;
}

/// Fills as much of *to as its owner was compiled with.
template <typename T>
void FillStruct(T value, const char* name, T* to) {
  CheckSize(*to, name);
  value.struct_size = to->struct_size;
  std::memcpy(to, &value, std::min<size_t>(sizeof(T), to->struct_size));
}

}  // namespace ossa::tracker
