// Simulated sensors beside real ones: the same statistics of rendered and of real frames.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "depth/base/error.h"
#include "depth/base/lower_case.h"
#include "depth/base/statistics.h"
#include "depth/image/depth_png.h"
#include "depth/sensor/frame_source.h"
#include "recon/motion/mocap.h"
#include "tools/experiments/experiments_internal.h"
#include "tools/experiments/sensor/sensor_statistics_internal.h"
#include "tools/synth/frame_maker.h"
#include "tools/synth/pose_bank.h"

namespace ossa::tools {
namespace {

namespace fs = std::filesystem;

SensorStatistics MeasureRealFrames(const fs::path& shared) {
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
      if (LowerCaseExtension(entry.path()) != ".png") continue;
      Gather(depth::ReadDepthPng(entry.path()), focal_px, statistics);
    }
  }
  return statistics;
}

void GatherFrame(const LabelledFrame& frame, SensorStatistics& statistics) {
  depth::Image<uint16_t> image(frame.depth.camera.width, frame.depth.camera.height);
  image.data = frame.depth.depth_mm;
  Gather(image, frame.depth.camera.fx, statistics);
}

std::vector<recon::RigPose> Bank(const ExperimentContext& context) {
  recon::MocapOptions mocap;
  mocap.seed = context.seed;
  return MakePoseBank(recon::LoadMocap({"authored"}, mocap));
}

// Frames of people in rooms, from the sensor of the options.
SensorStatistics MeasureRendered(ExperimentContext& context, FrameOptions options,
                                 const std::vector<View>& views, int64_t frames) {
  SensorStatistics statistics;
  const auto bank = Bank(context);
  options.split = Split::kTest;
  options.background = Background::kRoom;
  options.seed = context.seed;
  for (const View view : views) {
    options.view = view;
    const FrameInputs inputs(recon::BodyModel::Load(recon::BodyFolder()), bank, options);
    FrameMaker maker(inputs);
    for (int64_t i = 0; i < frames / static_cast<int64_t>(views.size()); ++i) {
      context.ThrowIfInterrupted();
      GatherFrame(maker.Make(i), statistics);
    }
  }
  return statistics;
}

// ITOP's side views: an Xtion's 320 x 240 shrunk 2.4 times by nearest neighbour, 45.6° wide.
constexpr double kItopFocal_px = 119.05;  // measured by the data's authors, in its README
constexpr double kItopShrink = 2.4;       // factor; measured, the same README
constexpr double kItopFov_deg = 45.6;     // derived: 2 atan(50 / 119.05)
constexpr double kAzureFov_deg = 64.8;    // derived: 2 atan(320 / 504), NFOV of an Azure Kinect

std::optional<SensorStatistics> MeasureItop(const fs::path& shared) {
  const fs::path folder = shared / "real/itop_depth/side";
  if (!fs::is_directory(folder)) return std::nullopt;
  SensorStatistics statistics;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (LowerCaseExtension(entry.path()) != ".png") continue;
    Gather(depth::ReadDepthPng(entry.path()), kItopFocal_px, statistics);
  }
  return statistics;
}

std::optional<SensorStatistics> MeasureAzure(const fs::path& shared) {
  const fs::path recording = shared / "real/recordings/azure_kinect.mkv";
  if (!fs::exists(recording)) return std::nullopt;
  SensorStatistics statistics;
  const auto source = depth::OpenSource(recording.string());
  while (true) {
    const depth::ReadResult read = source->Read(std::chrono::seconds(5));
    if (read.status != depth::ReadStatus::kFrame) break;
    depth::Image<uint16_t> image(read.frame.camera.width, read.frame.camera.height);
    image.data = read.frame.depth_mm;
    Gather(image, read.frame.camera.fx, statistics);
  }
  return statistics;
}

double PerTenThousand(int64_t part, int64_t whole) {
  return whole == 0 ? std::nan("") : 1e4 * static_cast<double>(part) / static_cast<double>(whole);
}

void AddRows(const std::string& sensor, const std::optional<SensorStatistics>& real,
             const SensorStatistics& made, Table& table) {
  const auto row = [&](const std::string& quantity, auto&& value) {
    table.rows.push_back(
        {sensor, quantity, real ? NumberCell(value(*real)) : "-", NumberCell(value(made))});
  };
  for (size_t b = 0; b < kSensorBandCount; ++b) {
    const auto residual = [b](const SensorStatistics& s) { return MedianOrNan(s.residuals_mm[b]); };
    if (std::isnan(residual(made)) && (!real || std::isnan(residual(*real)))) continue;
    row(fmt::format("plane residual at {} to {} m, mm", kSensorBands_m[b], kSensorBands_m[b + 1]),
        residual);
  }
  row("pixels without reading, %",
      [](const SensorStatistics& s) { return 100 - 1e-2 * PerTenThousand(s.readings, s.pixels); });
  row("single pixels missing in a surface, of 10 000",
      [](const SensorStatistics& s) { return PerTenThousand(s.pinholes, s.readings); });
  row("between the two surfaces of an edge, %",
      [](const SensorStatistics& s) { return 1e-2 * PerTenThousand(s.between, s.edges); });
}

// The other sensors, beside real frames if there are any.
Table OtherSensors(ExperimentContext& context, int64_t frames) {
  Table table{"Other sensors",
              {"sensor", "quantity", "real", "rendered"},
              {},
              "xtion: ITOP's side views and rendered ones of the same size, shrinking and field of "
              "view. azure: one recording, of a mug on a table, beside rendered people: its "
              "surfaces are nearer and smoother. Of the others there are no real frames."};
  FrameOptions itop;
  itop.sensors = {depth::SensorKind::kXtion};
  itop.width = itop.height = 100;
  itop.shrink = kItopShrink;
  itop.fov_deg = kItopFov_deg;
  AddRows("xtion", MeasureItop(context.shared),
          MeasureRendered(context, itop, {View::kFront}, frames), table);
  FrameOptions azure;
  azure.sensors = {depth::SensorKind::kAzure};
  azure.width = 640;
  azure.height = 576;
  azure.fov_deg = kAzureFov_deg;
  AddRows("azure", MeasureAzure(context.shared),
          MeasureRendered(context, azure, {View::kNear}, frames / 4), table);
  for (const auto kind : {depth::SensorKind::kKinectV2, depth::SensorKind::kD4xx}) {
    FrameOptions options;
    options.sensors = {kind};
    AddRows(std::string(depth::kSensorNames[static_cast<size_t>(kind)]), std::nullopt,
            MeasureRendered(context, options, {View::kFront}, frames / 4), table);
  }
  return table;
}

int ReadFrameCount(Parameters& parameters) { return parameters.Integer("frames", 24, 2, 10'000); }

}  // namespace

void ReadSensorParameters(ExperimentContext& context) { ReadFrameCount(context.parameters); }

std::vector<Table> RunSensor(ExperimentContext& context) {
  const int frames = ReadFrameCount(context.parameters);
  if (context.shared.empty()) {
    throw InputError("experiment sensor: expected --shared FOLDER with real/depth_frames");
  }
  const SensorStatistics real = MeasureRealFrames(context.shared);
  const SensorStatistics made = MeasureRendered(context, {}, {View::kNear, View::kFront}, frames);
  Table bands{"The sensor by distance",
              {"distance m", "step / z^2, real", "rendered", "plane residual mm, real", "rendered"},
              {},
              "step: median difference of readings that follow each other, 1e-6 / mm; residual: "
              "median over windows of 5 x 5 pixels. The real frames show people and, in one, a "
              "room; the rendered ones people in rooms."};
  for (size_t b = 0; b < kSensorBandCount; ++b) {
    bands.rows.push_back({fmt::format("{} to {}", kSensorBands_m[b], kSensorBands_m[b + 1]),
                          NumberCell(StepOverSquare(real.readings_mm[b])),
                          NumberCell(StepOverSquare(made.readings_mm[b])),
                          NumberCell(MedianOrNan(real.residuals_mm[b])),
                          NumberCell(MedianOrNan(made.residuals_mm[b]))});
  }
  Table holes{"What is not read",
              {"quantity", "real", "rendered"},
              {},
              "shadows: median width over f b (1/near - 1/far), b = 75 mm. The real frames with a "
              "background are registered to the colour camera, 25 mm from the infrared one on the "
              "projector's side: two thirds of a shadow stay at the left, one third opens at the "
              "right. The rendered ones are the infrared camera's own."};
  const auto row = [&](const std::string& name, double (*quantity)(const SensorStatistics&)) {
    holes.rows.push_back({name, NumberCell(quantity(real)), NumberCell(quantity(made))});
  };
  row("shadow at the left of the near surface",
      [](const SensorStatistics& s) { return MedianOrNan(s.left_shadows); });
  row("shadow at its right",
      [](const SensorStatistics& s) { return MedianOrNan(s.right_shadows); });
  row("single pixels missing in a surface, of 10 000", [](const SensorStatistics& s) {
    return 1e4 * static_cast<double>(s.pinholes) / static_cast<double>(s.readings);
  });
  return {bands, holes, OtherSensors(context, frames), SensorsBeforeWalls(context.seed)};
}

}  // namespace ossa::tools
