#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>

#include "ossa/ossa_c.h"
#include "tools/tracker/c_structs_internal.h"

/// What the files behind ossa_c.h share.
namespace ossa::tracker {

/// The one thing a C caller cannot be handed otherwise: why its thread's last call failed.
const char* LastError();
/// Takes no memory and throws nothing: what failed may have been for want of memory.
void SetLastError(const char* text) noexcept;

/// Runs `call`, which returns an ossa_status; what it throws becomes OSSA_FAILED and LastError.
template <typename Call>
ossa_status Guarded(const Call& call) {
  try {
    return call();
  } catch (const std::exception& error) {
    SetLastError(error.what());
  } catch (...) {
    SetLastError("unknown failure");
  }
  return OSSA_FAILED;
}

inline void RequireNotNull(const void* pointer, const char* call, const char* what) {
  if (pointer != nullptr) return;
  throw std::invalid_argument(std::string(call) + ": expected " + what + ", found NULL");
}

/// Throws unless there are so many of what a caller asks for one by its place.
inline void RequirePlace(int32_t place, size_t count, const char* call, const char* counted) {
  if (place >= 0 && static_cast<size_t>(place) < count) return;
  throw std::invalid_argument(std::string(call) + ": expected a place below the frame's " +
                              counted + ", " + std::to_string(count) + ", found " +
                              std::to_string(place));
}

inline std::string TextOr(const char* text, const char* otherwise) {
  return text == nullptr ? otherwise : text;
}

/// Throws unless struct_size can be: that of an earlier version of the struct (StructFacts), of
/// this one, or of a later one, which is not so much that it was never set.
template <typename T>
void CheckSize(const T& given) {
  using Facts = StructFacts<T>;
  static_assert(Facts::kEnd == sizeof(T), "padding at the end: what is added lies within it");
  constexpr size_t kMostAdded = 4096;  // bytes by which later versions may grow, by hand
  if (given.struct_size >= sizeof(T) && given.struct_size <= sizeof(T) + kMostAdded) return;
  constexpr auto earlier = Facts::kEarlier;
  if (std::find(earlier.begin(), earlier.end(), given.struct_size) != earlier.end()) return;
  throw std::invalid_argument(std::string(Facts::kName) + ".struct_size: expected sizeof(" +
                              Facts::kName + "), " + std::to_string(sizeof(T)) + ", found " +
                              std::to_string(given.struct_size));
}

/// What a caller handed over: members that it was compiled without are 0. Throws where it sets
/// members that this library does not know.
template <typename T>
T ReadStruct(const T& given) {
  CheckSize(given);
  const auto* bytes = reinterpret_cast<const unsigned char*>(&given);
  const bool known =
      given.struct_size <= sizeof(T) || std::all_of(bytes + sizeof(T), bytes + given.struct_size,
                                                    [](unsigned char b) { return b == 0; });
  if (!known) {
    throw std::invalid_argument(std::string(StructFacts<T>::kName) + ": a member behind byte " +
                                std::to_string(sizeof(T)) +
                                " is set, which this version of ossa does not know");
  }
  T value{};
  std::memcpy(&value, &given, std::min<size_t>(sizeof(T), given.struct_size));
  return value;
}

/// Fills as much of *to as its owner was compiled with.
template <typename T>
void FillStruct(T value, T* to) {
  CheckSize(*to);
  value.struct_size = to->struct_size;
  std::memcpy(to, &value, std::min<size_t>(sizeof(T), to->struct_size));
}

}  // namespace ossa::tracker
