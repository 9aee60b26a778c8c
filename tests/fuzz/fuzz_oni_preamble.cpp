// The part of an .oni that ossa itself reads: never past its end, whatever it says.
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "depth/sensor/oni_format_internal.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const auto preamble = ossa::depth::ParseOniPreamble({data, size});
  if (preamble.size > size || (preamble.seal && preamble.seal_at + 8 > preamble.size)) abort();
  if (preamble.camera && !(preamble.camera->fx > 0)) abort();
  return 0;
}
