// URIs of the virtual device: options in their ranges, or an InputError.
#include <cstdint>
#include <cstdlib>
#include <string>

#include "depth/base/error.h"
#include "depth/sensor/drivers/virtual_uri.h"
#include "tests/fuzz/seeds.h"

std::vector<std::string> ossa::fuzz::Seeds() {
  return {
      "a%3Fb/c?loop=1&speed=2&fps=15&mirror=1",
      "x.oni?unplug_after=30&replug_after_ms=200&unplugs=5&stall_after=7&restart_clock_after=9"};
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string uri = "ossa://" + std::string(reinterpret_cast<const char*>(data), size);
  try {
    const auto options = ossa::depth::ParseVirtualUri(uri);
    if (options.path.empty() || !(options.speed > 0) || (options.fps && !(*options.fps > 0))) {
      abort();
    }
  } catch (const ossa::InputError&) {
  }
  return 0;
}
