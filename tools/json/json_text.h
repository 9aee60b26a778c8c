#pragma once
#include <string>

namespace ossa::tools {

/// A JSON value as text, indented by two spaces. Invalid UTF-8, which file names may contain, is
/// replaced: dump() would throw.
template <typename Json>
std::string JsonText(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace ossa::tools
