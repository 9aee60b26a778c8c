#pragma once
// OpenNI2's driver interface, which needs two macros of OpenNI2's private base library.
#include <new>
#define XN_NEW(type, ...) new (std::nothrow) type(__VA_ARGS__)
#define XN_DELETE(pointer) delete (pointer)
#include <Driver/OniDriverAPI.h>

#include <cstring>
#include <string>

namespace ossa::depth {

/// Answers a property query of a fixed type.
template <typename T>
OniStatus AnswerProperty(const T& value, void* data, int* size) {
  if (*size < static_cast<int>(sizeof(T))) return ONI_STATUS_BAD_PARAMETER;
  std::memcpy(data, &value, sizeof(T));
  *size = sizeof(T);
  return ONI_STATUS_OK;
}

/// Fixed-length strings of OpenNI2's structs.
template <size_t N>
void CopyName(const std::string& text, char (&to)[N]) {
  std::memset(to, 0, N);
  std::memcpy(to, text.data(), std::min(text.size(), N - 1));
}

}  // namespace ossa::depth
