#include "depth/sensor/kinect_depth.h"

#include <cstddef>

// Constants: libfreenect's and PrimeSense's published figures.
namespace ossa::depth {

// Triangulation between projector and camera: a raw depth is a shift, in eighths of a pixel,
// relative to the shift of a reference plane at kReference_mm. With the shift s as a length in that
// plane and the baseline b, similar triangles give z = z0 + z0 s / (b - s).
std::array<uint16_t, 2048> AverageKinectDepthTable() {
  constexpr double kReference_mm = 1200.0;  // z0, and the next two: typical of PrimeSense's devices
  constexpr double kPixelAtReference_mm = 2.084;  // width of a (2 × 2 binned) pixel on that plane
  constexpr double kBaseline_mm = 75.0;
  constexpr double kShiftOfReference =
      200.0;                               // pixels, added by the device to keep shifts positive
  constexpr double kShiftsPerPixel = 4.0;  // shifts a pixel, no unit
  constexpr double kPixelOffset = 0.375;   // of the correlation window's middle
  constexpr double kFarthest_mm = 10000.0;
  std::array<uint16_t, 2048> table{};
  for (std::size_t raw = 0; raw < table.size() - 1; ++raw) {  // 2047 means no reading
    const double shift_px =
        (static_cast<double>(raw) - kShiftsPerPixel * kShiftOfReference) / kShiftsPerPixel -
        kPixelOffset;
    const double s_mm = shift_px * kPixelAtReference_mm / 2;
    if (s_mm >= kBaseline_mm) continue;
    const double z_mm = kReference_mm + kReference_mm * s_mm / (kBaseline_mm - s_mm);
    if (z_mm > 0 && z_mm < kFarthest_mm) table[raw] = static_cast<uint16_t>(z_mm);
  }
  return table;
}

}  // namespace ossa::depth
