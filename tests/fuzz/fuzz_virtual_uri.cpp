// URIs of the virtual device: options in their ranges, or an InputError.
#include <cstdint>
#include <cstdlib>
#include <string>

#include "depth/error.h"
#include "depth/sensor/drivers/virtual_uri.h"

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
