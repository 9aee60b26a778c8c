#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>

#include "ossa/ossa_c.h"
#include "tools/tracker/c_structs_internal.h"

/// Shared by the files that implement ossa_c.h.
namespace ossa::tracker {

/// The message of the last failed call of this thread, which C calls cannot return.
const char* LastError();
/// Does not allocate, because the failure may be a lack of memory.
void SetLastError(const char* text) noexcept;

/// Runs `call`, which returns an ossa_status; an exception becomes OSSA_FAILED and LastError.
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

/// Throws unless `place` is a valid index below `count`.
inline void RequirePlace(int32_t place, size_t count, const char* call, const char* counted) {
  if (place >= 0 && static_cast<size_t>(place) < count) return;
  throw std::invalid_argument(std::string(call) + ": expected a place below the frame's " +
                              counted + ", " + std::to_string(count) + ", found " +
                              std::to_string(place));
}

inline void CopyVector(const Eigen::Vector3d& from, float* to) {
  for (int i = 0; i < 3; ++i) to[i] = static_cast<float>(from[i]);
}

inline std::string TextOr(const char* text, const char* otherwise) {
  return text == nullptr ? otherwise : text;
}

/// Throws unless struct_size is plausible: of an earlier version of the struct (StructFacts), of
/// this one, or of a later one within a limit that uninitialised values exceed.
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

/// A caller's struct in this version; members it was compiled without are 0. Throws if it sets
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

/// Fills the part of *to that its owner was compiled with.
template <typename T>
void FillStruct(T value, T* to) {
  CheckSize(*to);
  value.struct_size = to->struct_size;
  std::memcpy(to, &value, std::min<size_t>(sizeof(T), to->struct_size));
}

}  // namespace ossa::tracker
