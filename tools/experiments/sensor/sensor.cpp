// The simulated sensor beside a real one: the same statistics of rendered frames and of a Kinect's.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "depth/base/error.h"
#include "depth/image/depth_png.h"
#include "recon/motion/mocap.h"
#include "tools/experiments/experiments_internal.h"
#include "tools/synth/frame_maker.h"
#include "tools/synth/pose_bank.h"

namespace ossa::tools {
namespace {

namespace fs = std::filesystem;

constexpr std::array kBands_m = {0.5, 1.0, 1.5,
                                 2.0, 3.0, 4.0};  // of distance, from each to the next
constexpr size_t kBandCount = kBands_m.size() - 1;
// Constants: of the Kinect v1's images, by hand.

constexpr double kEdge_m = 0.15;  // a jump between two surfaces
constexpr int kLongestShadow_px = 80;

/// What one sensor's frames say, gathered frame by frame.
struct SensorStatistics {
  std::array<std::vector<uint16_t>, kBandCount> readings_mm;  // in a frame's centre, all frames
  std::array<std::vector<double>, kBandCount> residuals_mm;   // of planes through 5 x 5 pixels
  // Widths of runs without reading between a far and a near surface, over what the projector's
  // baseline predicts, by the side of the near surface at which they lie in the image.
  std::vector<double> left_shadows, right_shadows;
  int64_t pinholes = 0;  // single pixels without reading inside a surface
  int64_t readings = 0;
};

std::optional<size_t> BandOf(double depth_m) {
  for (size_t b = 0; b < kBandCount; ++b) {
    if (depth_m >= kBands_m[b] && depth_m < kBands_m[b + 1]) return b;
  }
  return std::nullopt;
}

double Median(std::vector<double> values) {
  if (values.empty()) return std::nan("");
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Root mean square distance of 5 x 5 depths from their least-squares plane; nullopt at holes and
// jumps. On the regular grid the plane's slopes are independent sums.
std::optional<double> PlaneResidual_mm(const depth::Image<uint16_t>& image, int u, int v) {
  double sum = 0, along_u = 0, along_v = 0, squares = 0;
  const int middle = image.at(u, v);
  for (int dv = -2; dv <= 2; ++dv) {
    for (int du = -2; du <= 2; ++du) {
      const int z = image.at(u + du, v + dv);
      if (z == 0 || std::abs(z - middle) > 1e3 * kEdge_m) return std::nullopt;
      const double d = z - middle;  // small numbers, so that the squares keep their digits
      sum += d, along_u += du * d, along_v += dv * d, squares += d * d;
    }
  }
  constexpr double kCount = 25, kSlopes = 50;  // pixels; sum of squared offsets along one axis
  const double explained = sum * sum / kCount + (along_u * along_u + along_v * along_v) / kSlopes;
  return std::sqrt(std::max(0.0, squares - explained) / (kCount - 3));
}

// The projector stands beside the camera: what it does not light has no reading, f b (1/near -
// 1/far) pixels wide, on one side of the near surface.
void CountShadows(const depth::Image<uint16_t>& image, double focal_px, int v,
                  SensorStatistics& statistics) {
  constexpr double kBaseline_m = 0.075;  // Kinect v1: 75 mm
  for (int u = 1; u < image.width; ++u) {
    if (image.at(u, v) != 0 || image.at(u - 1, v) == 0) continue;
    int end = u;
    while (end < image.width && image.at(end, v) == 0) ++end;
    if (end == image.width || end - u > kLongestShadow_px) continue;
    const double left_m = 1e-3 * image.at(u - 1, v), right_m = 1e-3 * image.at(end, v);
    if (std::abs(left_m - right_m) < kEdge_m) continue;
    const double width_px = focal_px * kBaseline_m * std::abs(1.0 / left_m - 1.0 / right_m);
    if (width_px < 3) continue;  // lost in the raggedness of edges
    const bool near_follows = right_m < left_m;
    (near_follows ? statistics.left_shadows : statistics.right_shadows)
        .push_back((end - u) / width_px);
  }
}

void Gather(const depth::Image<uint16_t>& image, double focal_px, SensorStatistics& statistics) {
  for (int v = 2; v + 2 < image.height; ++v) {
    CountShadows(image, focal_px, v, statistics);
    for (int u = 2; u + 2 < image.width; ++u) {
      const uint16_t z = image.at(u, v);
      if (z == 0) {
        const std::array<int, 4> around = {image.at(u - 1, v), image.at(u + 1, v),
                                           image.at(u, v - 1), image.at(u, v + 1)};
        const auto [least, most] = std::minmax_element(around.begin(), around.end());
        statistics.pinholes += *least > 0 && *most - *least < 1e3 * kEdge_m;
        continue;
      }
      ++statistics.readings;
      const auto band = BandOf(1e-3 * z);
      if (!band) continue;
      statistics.readings_mm[*band].push_back(z);
      if (u % 3 != 0 || v % 3 != 0) continue;  // neighbouring windows say the same
      const auto residual = PlaneResidual_mm(image, u, v);
      if (residual) statistics.residuals_mm[*band].push_back(*residual);
    }
  }
}

// The median distance from one reading that occurs to the next, over the square of the distance:
// constant for a sensor that measures disparities in steps.
double StepOverSquare(std::vector<uint16_t> readings_mm) {
  std::sort(readings_mm.begin(), readings_mm.end());
  std::vector<double> steps;
  for (size_t i = 1; i < readings_mm.size(); ++i) {
    const double z = readings_mm[i], step = z - readings_mm[i - 1];
    if (step > 0) steps.push_back(1e6 * step / (z * z));
  }
  return Median(std::move(steps));
}

SensorStatistics OfRealFrames(const fs::path& shared) {
  // The camera's focal length at 640 pixels; skeltrack's is the SDK's, PCL's the ROS driver's.
  const std::array<std::pair<const char*, double>, 3> kFolders = {
      {{"skeltrack_v1", 575}, {"pcl_five_people", 525}, {"pcl_person", 525}}};
  SensorStatistics statistics;
  for (const auto& [name, focal_px] : kFolders) {
    const fs::path folder = shared / "real" / "depth_frames" / name;
    if (!fs::is_directory(folder)) {
      throw InputError(folder.string() + ": expected a folder of real depth frames (--shared)");
    }
    for (const auto& entry : fs::directory_iterator(folder)) {
      if (entry.path().extension() != ".png") continue;
      Gather(depth::ReadDepthPng(entry.path()), focal_px, statistics);
    }
  }
  return statistics;
}

SensorStatistics OfRenderedFrames(ExperimentContext& context, int64_t frames) {
  SensorStatistics statistics;
  recon::MocapOptions mocap;
  mocap.seed = context.seed;
  const auto bank = MakePoseBank(recon::LoadMocap({"authored"}, mocap));
  for (const View view : {View::kNear, View::kFront}) {
    FrameOptions options;
    options.view = view;
    options.split = Split::kTest;
    options.background = Background::kRoom;
    options.seed = context.seed;
    const FrameStudio studio(recon::BodyModel::Load(recon::BodyFolder()), bank, options);
    FrameMaker maker(studio);
    for (int64_t i = 0; i < frames / 2; ++i) {
      context.StopIfAsked();
      const LabelledFrame frame = maker.Make(i);
      const depth::Camera& camera = frame.depth.camera;
      depth::Image<uint16_t> image(camera.width, camera.height);
      image.data = frame.depth.depth_mm;
      Gather(image, camera.fx, statistics);
    }
  }
  return statistics;
}

std::string Cell(double value) { return std::isnan(value) ? "-" : fmt::format("{:.2f}", value); }

}  // namespace

std::vector<Table> RunSensor(ExperimentContext& context) {
  const int frames = context.parameters.Integer("frames", 24, 2, 10'000);
  if (context.shared.empty()) {
    throw InputError("experiment sensor: expected --shared FOLDER with real/depth_frames");
  }
  const SensorStatistics real = OfRealFrames(context.shared);
  const SensorStatistics made = OfRenderedFrames(context, frames);
  Table bands{"The sensor by distance",
              {"distance m", "step / z^2, real", "rendered", "plane residual mm, real", "rendered"},
              {},
              "step: median difference of readings that follow each other, 1e-6 / mm; residual: "
              "median over windows of 5 x 5 pixels. The real frames show people and, in one, a "
              "room; the rendered ones people in rooms."};
  for (size_t b = 0; b < kBandCount; ++b) {
    bands.rows.push_back({fmt::format("{} to {}", kBands_m[b], kBands_m[b + 1]),
                          Cell(StepOverSquare(real.readings_mm[b])),
                          Cell(StepOverSquare(made.readings_mm[b])),
                          Cell(Median(real.residuals_mm[b])), Cell(Median(made.residuals_mm[b]))});
  }
  Table holes{"What is not read",
              {"quantity", "real", "rendered"},
              {},
              "shadows: median width over f b (1/near - 1/far), b = 75 mm. The real frames with a "
              "background are registered to the colour camera, 25 mm from the infrared one on the "
              "projector's side: two thirds of a shadow stay at the left, one third opens at the "
              "right. The rendered ones are the infrared camera's own."};
  const auto row = [&](const std::string& name, double (*quantity)(const SensorStatistics&)) {
    holes.rows.push_back({name, Cell(quantity(real)), Cell(quantity(made))});
  };
  row("shadow at the left of the near surface",
      [](const SensorStatistics& s) { return Median(s.left_shadows); });
  row("shadow at its right", [](const SensorStatistics& s) { return Median(s.right_shadows); });
  row("single pixels missing in a surface, of 10 000", [](const SensorStatistics& s) {
    return 1e4 * static_cast<double>(s.pinholes) / static_cast<double>(s.readings);
  });
  return {bands, holes};
}

}  // namespace ossa::tools
