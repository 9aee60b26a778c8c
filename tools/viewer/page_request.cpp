#include <algorithm>
#include <nlohmann/json.hpp>

#include "depth/base/error.h"
#include "depth/base/json_nesting.h"
#include "tools/viewer/page_request_internal.h"

namespace ossa::viewer {
namespace {

using Json = nlohmann::json;

int64_t WholeNumber(const Json& json, const char* name, int64_t least, int64_t most) {
  const Json& value = json.at(name);
  if (value.is_number_integer() && value >= least && value <= most) return value;
  throw InputError(std::string(name) + ": expected a whole number from " + std::to_string(least) +
                   " to " + std::to_string(most));
}

bool Flag(const Json& json, const char* name) {
  if (!json.at(name).is_boolean()) throw InputError(std::string(name) + ": expected true or false");
  return json.at(name);
}

std::string OneOf(const Json& json, const char* name, const std::vector<std::string>& names) {
  const Json& value = json.at(name);
  if (value.is_string() && std::count(names.begin(), names.end(), value.get<std::string>()) > 0) {
    return value;
  }
  throw InputError(std::string(name) + ": expected one of those that the state lists");
}

Settings ReadSettings(const Json& json, const SharedState& shared) {
  if (!json.is_object()) throw InputError("settings: expected an object");
  const std::optional<Settings> before = shared.settings();
  if (!before) throw InputError("settings: nothing can be changed");
  Settings settings = *before;
  std::vector<std::string> smoothings = shared.options.smoothings;
  smoothings.emplace_back();  // the default of the method
  if (json.contains("method")) settings.method = OneOf(json, "method", shared.options.methods);
  if (json.contains("smoothing")) settings.smoothing = OneOf(json, "smoothing", smoothings);
  if (json.contains("seated")) settings.seated = Flag(json, "seated");
  if (json.contains("near")) settings.near_range = Flag(json, "near");
  if (json.contains("users")) {
    constexpr int kMostUsers = 6;  // as of the Kinect SDK
    settings.users = static_cast<int>(WholeNumber(json, "users", 1, kMostUsers));
  }
  return settings;
}

Json ParseObject(std::string_view text) {
  if (JsonNesting().IsTooDeep(text)) throw InputError("expected a flat JSON object");
  Json json = Json::parse(text, nullptr, false);
  if (json.is_discarded() || !json.is_object()) throw InputError("expected a JSON object");
  return json;
}

}  // namespace

PageRequest ParsePageRequest(std::string_view text, const SharedState& shared) {
  constexpr int64_t kMostFrames = int64_t{1} << 40;  // count; beyond any recording: by hand
  constexpr int kLargestStep = 4;                    // pixels: 160 x 120 of 640 x 480, by hand
  const Json json = ParseObject(text);
  PageRequest page_request;
  if (json.contains("frame")) page_request.frame = WholeNumber(json, "frame", 0, kMostFrames);
  if (json.contains("after")) page_request.after = WholeNumber(json, "after", -1, kMostFrames);
  if (json.contains("step"))
    page_request.step = static_cast<int>(WholeNumber(json, "step", 1, kLargestStep));
  if (json.contains("settings")) page_request.settings = ReadSettings(json["settings"], shared);
  if (json.contains("record")) page_request.record = Flag(json, "record");
  return page_request;
}

}  // namespace ossa::viewer
