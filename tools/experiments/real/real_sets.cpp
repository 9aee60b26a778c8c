// Reads all data below SHARED/real: stills with truth, and recordings without.
#include "tools/experiments/real/real_sets_internal.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>

#include "depth/base/error.h"
#include "depth/base/lower_case.h"
#include "depth/image/camera_io.h"
#include "depth/image/depth_png.h"
#include "depth/sensor/frame_source.h"
#include "tools/experiments/compare/select_evenly.h"

namespace ossa::tools {
namespace {

namespace fs = std::filesystem;
using recon::Joint;

// Joints marked by eye on skeltrack_v1 where they project onto the surface: file, joint, u, v in
// pixels of 640 x 480.
constexpr const char* kSkeltrackMarks =
#include "tools/experiments/real/kinect_marks.inc"
    ;

// ITOP's 15 joints and the nearest of ours. Its neck, torso, hips and feet are defined differently:
// a constant offset per joint is removed before comparison.
struct ItopJoint {
  const char* name;
  Joint joint;
};
constexpr std::array kItopJoints = {ItopJoint{"Head", Joint::kHead},
                                    ItopJoint{"Neck", Joint::kShoulderCenter},
                                    ItopJoint{"RShoulder", Joint::kShoulderRight},
                                    ItopJoint{"LShoulder", Joint::kShoulderLeft},
                                    ItopJoint{"RElbow", Joint::kElbowRight},
                                    ItopJoint{"LElbow", Joint::kElbowLeft},
                                    ItopJoint{"RHand", Joint::kHandRight},
                                    ItopJoint{"LHand", Joint::kHandLeft},
                                    ItopJoint{"Torso", Joint::kSpine},
                                    ItopJoint{"RHip", Joint::kHipRight},
                                    ItopJoint{"LHip", Joint::kHipLeft},
                                    ItopJoint{"RKnee", Joint::kKneeRight},
                                    ItopJoint{"LKnee", Joint::kKneeLeft},
                                    ItopJoint{"RFoot", Joint::kFootRight},
                                    ItopJoint{"LFoot", Joint::kFootLeft}};

// ITOP's 320 x 240 images (f = 1 / 0.0035 px) shrunk 2.4 times and cut to a square, by the data's
// README.
constexpr depth::Camera kItopCamera{
    .width = 100, .height = 100, .fx = 119.05, .fy = 119.05, .cx = 49.71, .cy = 49.71};
// The one image whose depth scale is ambiguous, by the data's README.
constexpr const char* kItopAmbiguous = "top/046";
// A Kinect v1's image, cropped to its colour ramp, by the data's README.
constexpr depth::Camera kSeatedCamera{
    .width = 474, .height = 490, .fx = 585, .fy = 585, .cx = 154, .cy = 245};
constexpr double kKinectFrame_s = 1.0 / 30.0;  // of a Kinect v1, by its data sheet

std::vector<fs::path> ListPngs(const fs::path& folder) {
  std::vector<fs::path> files;
  if (!fs::is_directory(folder)) return files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (LowerCaseExtension(entry.path()) == ".png") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

// A limit of stills for SelectEvenly(); 0: none.
size_t ToLimit(int most) {
  return most > 0 ? static_cast<size_t>(most) : std::numeric_limits<size_t>::max();
}

depth::DepthFrame ReadFrame(const fs::path& png, const std::optional<depth::Camera>& camera,
                            double time_s) {
  const depth::Image<uint16_t> image = depth::ReadDepthPng(png);
  depth::DepthFrame frame;
  frame.camera = camera ? *camera : depth::KinectV1Camera(image.width, image.height);
  if (frame.camera.width != image.width || frame.camera.height != image.height) {
    throw InputError(fmt::format("{}: expected {} x {} pixels, found {} x {}", png.string(),
                                 frame.camera.width, frame.camera.height, image.width,
                                 image.height));
  }
  frame.depth_mm = image.data;
  frame.time_s = time_s;
  return frame;
}

struct Mark {
  Joint joint;
  Eigen::Vector2d pixel;
};

// Lines of `file joint u v`, from ossa's own marks or beside the images.
std::multimap<std::string, Mark> ParseMarks(std::istream& in, const std::string& name) {
  std::multimap<std::string, Mark> marks;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    if (line.empty() || line.front() == '#') continue;
    std::istringstream words(line);
    std::string file, joint_name;
    Eigen::Vector2d pixel;
    words >> file >> joint_name >> pixel.x() >> pixel.y();
    const auto joint = recon::JointFromName(joint_name);
    if (!words || !joint) {
      throw InputError(
          fmt::format("{}: line {}: expected FILE JOINT U V, found '{}'", name, number, line));
    }
    marks.emplace(file, Mark{*joint, pixel});
  }
  return marks;
}

std::multimap<std::string, Mark> ReadMarks(const fs::path& folder) {
  const fs::path beside = folder / "marks.txt";
  if (std::ifstream file(beside); file) return ParseMarks(file, beside.string());
  if (folder.filename() != "skeltrack_v1") return {};
  std::istringstream own(kSkeltrackMarks);
  return ParseMarks(own, "marks of skeltrack_v1");
}

RealSet MarkedSet(const fs::path& folder, const std::multimap<std::string, Mark>& marks, int most) {
  RealSet set{.name = folder.filename().string(), .offsets_from_other_half = false};
  for (const auto& [file, mark] : marks) {
    if (std::find(set.joints.begin(), set.joints.end(), mark.joint) == set.joints.end()) {
      set.joints.push_back(mark.joint);
      set.joint_names.emplace_back(recon::NameOf(mark.joint));
    }
  }
  for (const fs::path& png : SelectEvenly(ListPngs(folder), ToLimit(most))) {
    RealStill still{.name = png.filename().string(), .frame = ReadFrame(png, std::nullopt, 0.0)};
    still.truth.resize(set.joints.size());
    const auto [first, last] = marks.equal_range(still.name);
    for (auto mark = first; mark != last; ++mark) {
      const auto at = std::find(set.joints.begin(), set.joints.end(), mark->second.joint);
      still.truth[static_cast<size_t>(at - set.joints.begin())].pixel = mark->second.pixel;
    }
    if (first != last) set.stills.push_back(std::move(still));
  }
  return set;
}

std::vector<std::string> CommaCells(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream in(line.ends_with('\r') ? line.substr(0, line.size() - 1) : line);
  for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
  return cells;
}

// A table whose first line names its columns.
struct CsvTable {
  std::string name;
  std::map<std::string, size_t> column;
  std::vector<std::vector<std::string>> rows;

  std::optional<double> Number(size_t row, const std::string& key) const {
    const auto at = column.find(key);
    if (at == column.end()) {
      throw InputError(fmt::format("{}: line 1: expected a column '{}'", name, key));
    }
    const std::vector<std::string>& cells = rows[row];
    if (at->second >= cells.size()) {
      throw InputError(fmt::format("{}: line {}: expected {} cells, found {}", name, row + 2,
                                   column.size(), cells.size()));
    }
    const std::string& text = cells[at->second];
    double value = 0;
    const auto end = std::from_chars(text.data(), text.data() + text.size(), value);
    if (end.ec != std::errc() || !std::isfinite(value)) return std::nullopt;
    return value;
  }
};

CsvTable ReadCsv(const fs::path& path) {
  CsvTable table{.name = path.string(), .column = {}, .rows = {}};
  std::ifstream file(path);
  std::string line;
  if (!std::getline(file, line)) throw InputError(table.name + ": line 1: expected column names");
  const auto names = CommaCells(line);
  for (size_t c = 0; c < names.size(); ++c) table.column[names[c]] = c;
  while (std::getline(file, line)) {
    if (!line.empty()) table.rows.push_back(CommaCells(line));
  }
  return table;
}

// ITOP's x grows to the right of the image, ours to the sensor's left.
std::optional<Eigen::Vector3d> ItopPoint(const CsvTable& table, size_t row,
                                         const std::string& joint) {
  const auto x = table.Number(row, joint + "_x"), y = table.Number(row, joint + "_y"),
             z = table.Number(row, joint + "_z");
  if (!x || !y || !z) return std::nullopt;
  return Eigen::Vector3d(-*x, *y, *z);
}

// `side` or `top`; the truth's keys begin with that letter in capitals. Only the side has a peer.
RealSet ItopSet(const fs::path& folder, const std::string& view, int most) {
  const CsvTable table = ReadCsv(folder / "truth.csv");
  RealSet set{.name = "itop_" + view, .peer = view == "side" ? "A2J" : ""};
  for (const ItopJoint& joint : kItopJoints) {
    set.joints.push_back(joint.joint);
    set.joint_names.emplace_back(joint.name);
  }
  const std::string truth = view == "side" ? "S_" : "T_";
  std::vector<size_t> rows(table.rows.size());
  for (size_t r = 0; r < rows.size(); ++r) rows[r] = r;
  for (const size_t row : SelectEvenly(rows, ToLimit(most))) {
    const auto sample = table.Number(row, "sample");
    if (!sample)
      throw InputError(fmt::format("{}: line {}: expected a sample's number", table.name, row + 2));
    const std::string name = fmt::format("{}/{:03}", view, static_cast<int>(*sample));
    const fs::path png = folder / (name + ".png");
    if (name == kItopAmbiguous || !fs::exists(png)) continue;
    RealStill still{.name = name, .frame = ReadFrame(png, kItopCamera, 0.0)};
    for (const ItopJoint& joint : kItopJoints) {
      still.truth.push_back({.position_m = ItopPoint(table, row, truth + joint.name), .pixel = {}});
      if (!set.peer.empty()) {
        still.peer_m.push_back(ItopPoint(table, row, std::string("A2J_") + joint.name));
      }
    }
    set.stills.push_back(std::move(still));
  }
  return set;
}

std::vector<fs::path> FoldersIn(const fs::path& folder) {
  std::vector<fs::path> folders;
  if (!fs::is_directory(folder)) return folders;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.is_directory()) folders.push_back(entry.path());
  }
  std::sort(folders.begin(), folders.end());
  return folders;
}

// A video's frames are named by their numbers at the Kinect's 30 a second, some left out.
RealVideo SeatedVideo(const fs::path& folder, int most) {
  RealVideo video{.name = "kinect_v1_seated_video", .frames = {}};
  auto files = ListPngs(folder / "depth");
  if (most > 0 && files.size() > static_cast<size_t>(most)) files.resize(static_cast<size_t>(most));
  for (const fs::path& png : files) {
    int number = 0;
    const std::string stem = png.stem().string();
    std::from_chars(stem.data(), stem.data() + stem.size(), number);
    video.frames.push_back(ReadFrame(png, kSeatedCamera, number * kKinectFrame_s));
  }
  return video;
}

// Stills of a Kinect v1, unless camera.json says otherwise.
RealVideo StillsWithoutTruth(const fs::path& folder, int most) {
  RealVideo video{.name = folder.filename().string(), .frames = {}, .stills = true};
  std::optional<depth::Camera> camera;
  if (fs::exists(folder / "camera.json")) camera = depth::ReadCameraJson(folder / "camera.json");
  for (const fs::path& png : SelectEvenly(ListPngs(folder), ToLimit(most))) {
    video.frames.push_back(ReadFrame(png, camera, 0.0));
  }
  return video;
}

RealVideo Recording(const fs::path& path, int most) {
  RealVideo video{.name = path.filename().string(), .frames = {}};
  const auto source = depth::OpenSource(path.string());
  while (most <= 0 || video.frames.size() < static_cast<size_t>(most)) {
    depth::ReadResult read = source->Read(std::chrono::seconds(5));
    if (read.status != depth::ReadStatus::kFrame) break;
    video.frames.push_back(std::move(read.frame));
  }
  return video;
}

}  // namespace

std::vector<RealSet> ReadRealSets(const fs::path& shared, int most) {
  std::vector<RealSet> sets;
  for (const fs::path& folder : FoldersIn(shared / "real/depth_frames")) {
    const auto marks = ReadMarks(folder);
    if (!marks.empty()) sets.push_back(MarkedSet(folder, marks, most));
  }
  const fs::path itop = shared / "real/itop_depth";
  for (const std::string view : {"side", "top"}) {
    if (fs::is_directory(itop / view)) sets.push_back(ItopSet(itop, view, most));
  }
  std::erase_if(sets, [](const RealSet& set) { return set.stills.empty(); });
  return sets;
}

std::vector<RealVideo> ReadRealVideos(const fs::path& shared, int most) {
  std::vector<RealVideo> videos;
  videos.push_back(SeatedVideo(shared / "real/kinect_v1_seated_video", most));
  for (const fs::path& folder : FoldersIn(shared / "real/depth_frames")) {
    if (ReadMarks(folder).empty()) videos.push_back(StillsWithoutTruth(folder, most));
  }
  const fs::path recordings = shared / "real/recordings";
  if (fs::is_directory(recordings)) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(recordings)) {
      if (depth::IsRecording(entry.path())) files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    for (const fs::path& file : files) videos.push_back(Recording(file, most));
  }
  std::erase_if(videos, [](const RealVideo& video) { return video.frames.empty(); });
  return videos;
}

}  // namespace ossa::tools
