#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "tools/viewer/shared_state_internal.h"

namespace ossa::viewer {

/// A request of a page over its WebSocket: one JSON object a message, each answered by one message.
///   {"frame": N, "step": S}    the frame N of a recording: binary
///   {"after": N, "step": S}    the newest frame once it is not N: binary, or the state after 1 s
///   {"state": true}            the state: text
///   {"settings": {...}}        members as in the state, others unchanged: the state
///   {"record": true|false}     the record button: the state
struct PageRequest {
  std::optional<int64_t> frame, after;
  int step = 1;  // of pixels and rows that are sent: 1, 2 or 4
  std::optional<Settings> settings;
  std::optional<bool> record;
};

/// Throws InputError of one line for an invalid message.
PageRequest ParsePageRequest(std::string_view text, const SharedState& shared);

}  // namespace ossa::viewer
