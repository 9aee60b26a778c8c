#pragma once
#include <string>

namespace ossa::tools {

/// A JSON value as people read it, two spaces a level. Bytes that are no UTF-8, as names of files
/// may hold, are replaced: dump() alone throws at them, after all the work.
template <typename Json>
std::string JsonText(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace ossa::tools
