#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "tools/viewer/desk_internal.h"

namespace ossa::viewer {

/// What a page says over its WebSocket, one JSON object a message; each is answered by one message.
///   {"frame": N, "step": S}    the moment N of a recording: binary
///   {"after": N, "step": S}    the newest moment once it is not N: binary, or the state after 1 s
///   {"state": true}            the state: text
///   {"settings": {...}}        members as in the state; those left out stay: the state
///   {"record": true|false}     the record button: the state
struct Wish {
  std::optional<int64_t> frame, after;
  int step = 1;  // of pixels and rows that are sent: 1, 2 or 4
  std::optional<Settings> settings;
  std::optional<bool> record;
};

/// Throws InputError in one line for what is no such message.
Wish ReadWish(std::string_view text, const Desk& desk);

}  // namespace ossa::viewer
