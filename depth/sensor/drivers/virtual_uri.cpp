#include "depth/sensor/drivers/virtual_uri.h"

#include <charconv>
#include <cmath>
#include <cstring>

#include "depth/base/error.h"

namespace ossa::depth {
namespace {

// Constants: bounds of a URI's numbers, by hand; no unit but their options' own.

int HexDigit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

std::string Decoded(const std::string& text, const std::string& uri) {
  std::string decoded;
  for (size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      decoded.push_back(text[i]);
      continue;
    }
    const int high = i + 2 < text.size() ? HexDigit(text[i + 1]) : -1;
    const int low = i + 2 < text.size() ? HexDigit(text[i + 2]) : -1;
    if (high < 0 || low < 0 || high + low == 0) {
      throw InputError(uri + ": path: expected two hexadecimal digits after %");
    }
    decoded.push_back(static_cast<char>(16 * high + low));
    i += 2;
  }
  return decoded;
}

// Parses a number in [least, most].
double Number(const std::string& uri, const std::string& key, const std::string& value,
              double least, double most) {
  double number = 0.0;
  const char* end = value.data() + value.size();
  const auto [at, error] = std::from_chars(value.data(), end, number);
  if (error != std::errc() || at != end || !(number >= least && number <= most)) {
    const auto text = [](double x) { return std::to_string(static_cast<long>(std::ceil(x))); };
    throw InputError(uri + ": " + key + ": expected a number from " + (least < 1 ? "0" : "1") +
                     " to " + text(most) + ", found '" + value + "'");
  }
  return number;
}

void SetOption(const std::string& uri, const std::string& key, const std::string& value,
               VirtualDeviceOptions* options) {
  constexpr double kTiny = 1e-3;
  constexpr double kFastest = 1000;
  constexpr double kMostFrames = 1e9;
  const auto number = [&](double least, double most) {
    return Number(uri, key, value, least, most);
  };
  if (key == "loop") {
    options->loop = number(0, 1) != 0;
  } else if (key == "mirror") {
    options->mirror = number(0, 1) != 0;
  } else if (key == "mirrored") {
    options->mirrored = number(0, 1) != 0;
  } else if (key == "speed") {
    options->speed = number(kTiny, kFastest);
  } else if (key == "fps") {
    options->fps = number(kTiny, kFastest);
  } else if (key == "unplug_after") {
    options->unplug_after = static_cast<int>(number(1, kMostFrames));
  } else if (key == "replug_after_ms") {
    options->replug_after = std::chrono::milliseconds(static_cast<int>(number(0, kMostFrames)));
  } else if (key == "unplugs") {
    options->unplugs = static_cast<int>(number(0, kMostFrames));
  } else if (key == "stall_after") {
    options->stall_after = static_cast<int>(number(0, kMostFrames));
  } else if (key == "restart_clock_after") {
    options->restart_clock_after = static_cast<int>(number(0, kMostFrames));
  } else {
    throw InputError(uri + ": expected loop, speed, fps, mirror, mirrored, unplug_after, " +
                     "replug_after_ms, unplugs, stall_after or restart_clock_after, found '" + key +
                     "'");
  }
}

}  // namespace

VirtualDeviceOptions ParseVirtualUri(const std::string& uri) {
  if (!uri.starts_with(kVirtualScheme)) {
    throw InputError(uri + ": expected ossa://PATH");
  }
  const size_t question = uri.find('?');
  const size_t path_at = std::strlen(kVirtualScheme);
  VirtualDeviceOptions options;
  options.path = Decoded(uri.substr(path_at, question - path_at), uri);
  if (options.path.empty()) throw InputError(uri + ": expected a path after ossa://");
  if (question == std::string::npos) return options;
  size_t at = question + 1;
  while (at < uri.size()) {
    const size_t end = std::min(uri.find('&', at), uri.size());
    const std::string part = uri.substr(at, end - at);
    const size_t equals = part.find('=');
    if (equals == std::string::npos) {
      throw InputError(uri + ": expected key=value, found '" + part + "'");
    }
    SetOption(uri, part.substr(0, equals), part.substr(equals + 1), &options);
    at = end + 1;
  }
  return options;
}

}  // namespace ossa::depth
