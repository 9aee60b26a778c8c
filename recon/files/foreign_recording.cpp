#include "recon/files/foreign_recording_internal.h"

#include <array>

namespace ossa::recon {
namespace {

constexpr std::string_view kExport = "export it as BVH, TRC or C3D";
constexpr std::string_view kJsonl =
    "write it as ossa's JSONL, metres (docs/files.md, 'Any other recording')";
// Also the answer for such a table if its first lines are damaged.
constexpr std::string_view kNamed =
    "write it as ossa's JSONL, or as a table of lines FRAME JOINT x y z (docs/files.md, 'Tables of "
    "named joints')";
constexpr std::string_view kUnpack = "unpack it, or pack it as .zip, .tar.gz or .gz";
constexpr std::string_view kLines =
    "write an object a frame, each on a line of its own (jq -c '.[]' of an array, jq -c . else)";
constexpr std::string_view kFlat =
    "they lie in the image, ossa reads joints in metres: track the depth images instead";

struct ForeignRecording {
  std::string_view name;
  std::string_view how;                   // how to convert it
  bool at_begin;                          // the file starts with the first mark
  std::array<std::string_view, 2> marks;  // all occur in the head of the file, lower case
};

// Unambiguous formats first, by the marks of their programs (FBX SDK, Xsens MVN, OptiTrack Motive,
// Vicon Nexus, Acclaim, NumPy, pickle protocols 2 to 5, MATLAB, HDF5, glTF, OpenPose and AlphaPose,
// COCO, MediaPipe's landmarks, Kinect SDK names).
constexpr ForeignRecording kForeign[] = {
    {"FBX", "export it as BVH (Blender: File, Export, Motion Capture)", true, {"kaydara fbx", ""}},
    {"FBX", "export it as BVH (Blender: File, Export, Motion Capture)", true, {"; fbx", ""}},
    {"Xsens MVN's XML", "export it as BVH or C3D", false, {"<mvnx", ""}},
    {"OptiTrack Motive's CSV", kExport, false, {"format version", "capture frame rate"}},
    {"Vicon Nexus' CSV", "export it as C3D or TRC", false, {"sub frame", ""}},
    {"an Acclaim skeleton", "it holds no motion", false, {":bonedata", ""}},
    {"an Acclaim motion",
     "ossa render and ossa database read it; convert it to BVH",
     false,
     {":fully-specified", ""}},
    {"a NumPy array", kJsonl, true, {"\x93numpy", ""}},
    {"a Python pickle (SMPL's parameters are such)", kJsonl, true, {"\x80", ""}},
    {"a MATLAB file", kJsonl, true, {"matlab 5.0 mat-file", ""}},
    {"an OpenSim table (MOT or STO)",
     "export its markers as TRC",
     false,
     {"endheader", "ncolumns="}},
    {"a JSON array of frames", kLines, true, {"[", "\"bodies\""}},
    {"JSON over several lines", kLines, true, {"{\n", "\"bodies\""}},
    {"JSON over several lines", kLines, true, {"{\r\n", "\"bodies\""}},
    {"a packed file (xz)",
     kUnpack,
     true,
     {"\xFD"
      "7zxz",
      ""}},
    {"a packed file (bzip2)", kUnpack, true, {"bzh", "1ay&sy"}},
    {"a packed file (zstd)", kUnpack, true, {"\x28\xB5\x2F\xFD", ""}},
    {"a packed file (7z)", kUnpack, true, {"7z\xBC\xAF", ""}},
    {"a packed file (RAR)", kUnpack, true, {"rar!\x1A", ""}},
    {"an HDF5 file", kJsonl, true, {"\x89hdf", ""}},
    {"glTF", "ossa writes it; write .jsonl beside it to read it again", true, {"gltf", ""}},
    {"2D key points (OpenPose)", kFlat, false, {"pose_keypoints_2d", ""}},
    {"2D key points (COCO)", kFlat, false, {"\"keypoints\"", ""}},
    {"2D key points", kFlat, false, {"nose_x", "nose_score"}},
    {"2D key points", kFlat, false, {"nose_x", "nose_likelihood"}},
    {"MediaPipe's landmarks", kJsonl, false, {"left_eye_inner", ""}},
    {"MediaPipe's landmarks", kJsonl, false, {"landmarks", "visibility"}},
    {"joints by name", kNamed, false, {"spinebase", ""}},
    {"joints by name", kNamed, false, {"hipcenter", ""}},
    {"joints by name", kNamed, false, {"left_shoulder", "left_knee"}},
    {"joints by name", kNamed, false, {"leftshoulder", "leftknee"}},
    {"joints by name", kNamed, false, {"shoulderleft", "kneeleft"}},
    {"joints by name", kNamed, false, {"shoulder_left", "knee_left"}},
};

// ASCII lower case, whatever the locale.
std::string InSmallLetters(std::string_view text) {
  std::string small(text);
  for (char& c : small) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return small;
}

bool Is(const ForeignRecording& foreign, std::string_view small) {
  const auto& [first, second] = foreign.marks;
  const bool has_first =
      foreign.at_begin ? small.starts_with(first) : small.find(first) != small.npos;
  return has_first && small.find(second) != small.npos;
}

}  // namespace

std::string DescribeForeignRecording(std::string_view head) {
  const std::string small = InSmallLetters(head);
  for (const ForeignRecording& foreign : kForeign) {
    if (!Is(foreign, small)) continue;
    return std::string(foreign.name).append(": ").append(foreign.how);
  }
  return {};
}

}  // namespace ossa::recon
