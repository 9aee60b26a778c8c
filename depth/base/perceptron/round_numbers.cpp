#include <cmath>

#include "depth/base/cpu_dispatch.h"
#include "depth/base/perceptron/round_numbers_internal.h"

namespace ossa {

OSSA_CPU_DISPATCH void RoundNumbers(const float* numbers, float times, size_t count,
                                    int16_t* rounded) {
  for (size_t i = 0; i < count; ++i) {
    rounded[i] = static_cast<int16_t>(std::rint(numbers[i] * times));
  }
}

}  // namespace ossa
