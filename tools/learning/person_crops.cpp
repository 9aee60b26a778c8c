#include "tools/learning/person_crops.h"

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "depth/base/atomic_file.h"
#include "depth/base/threads.h"
#include "depth/base/train_interrupted.h"
#include "recon/posture.h"
#include "recon/refine/person_crop.h"
#include "tools/learning/segmented_person.h"
#include "tools/synth/dataset.h"

namespace ossa::tools {
namespace {

// Constants: by hand, and of the files.

// One person, as it stands in the files.
struct CropRow {
  std::array<std::array<uint8_t, recon::kCropCells>, 2> cells{};
  std::array<std::array<float, 3>, recon::kJointCount> joints{};
  float range_m = 0.0F;
  bool known = false;
};

// An .npy file of a head and rows, format 1.0.
class NumpyFile {
 public:
  NumpyFile(const std::filesystem::path& path, const char* type, const std::string& shape)
      : file_(path) {
    constexpr size_t kHead = 128, kMagic = 10;  // bytes, of the format
    std::string head =
        fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}), }}", type, shape);
    head.resize(kHead - kMagic - 1, ' ');
    head += '\n';
    const std::array<char, 4> start = {1, 0, static_cast<char>(head.size()), 0};
    file_.stream() << "\x93NUMPY";
    file_.stream().write(start.data(), start.size());
    file_.stream() << head;
  }
  template <typename T>
  void Write(const T& row) {
    file_.stream().write(reinterpret_cast<const char*>(&row), sizeof(row));
  }
  void Check() { file_.Check(); }
  void Commit() { file_.Commit(); }

 private:
  AtomicFile file_;
};

uint8_t EncodeBehind(const recon::PersonCrop::Cell& cell) {
  constexpr double kStep_mm = 10.0;
  constexpr double kNought = 128.0;  // steps, no unit: half of a byte's range
  if (cell.surface == 0) return static_cast<uint8_t>(kNought);
  const double steps = std::round(cell.behind_mm / kStep_mm) + kNought;
  return static_cast<uint8_t>(std::clamp(steps, 0.0, 255.0));
}

void ReadRow(const DatasetReader& reader, int64_t number, CropRow* row) {
  constexpr double kNearest_m = 0.1;  // a joint before the camera
  *row = {};
  for (auto& joint : row->joints) joint.fill(std::numeric_limits<float>::quiet_NaN());
  const auto person = ReadSegmented(reader, number);
  if (!person) return;
  const auto crop = recon::PersonCrop::Cut(person->frame.depth, person->is_person);
  if (!crop) return;
  for (size_t c = 0; c < crop->cells.size(); ++c) {
    const recon::PersonCrop::Cell& cell = crop->cells[c];
    row->cells[0][c] = EncodeBehind(cell);
    row->cells[1][c] = static_cast<uint8_t>((recon::kCropTaps + 1) * cell.surface + cell.hidden);
  }
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    const Eigen::Vector3d& joint_m = person->body.joints_m.position_m[j];
    if (!(joint_m.z() > kNearest_m)) continue;
    const Eigen::Vector3f at_m = crop->Project(joint_m).cast<float>();
    std::ranges::copy(at_m, row->joints[j].begin());
  }
  row->range_m = static_cast<float>(crop->middle_m.norm());
  row->known = true;
}

}  // namespace

int64_t WritePersonCrops(const std::filesystem::path& dataset, const std::filesystem::path& out,
                         const PersonCropOptions& options) {
  const ThreadLimit limit(options.threads);
  const DatasetReader reader(dataset);
  const int64_t frames = reader.frame_count();
  std::filesystem::create_directories(out);
  NumpyFile crops(out / "crops.npy", "|u1",
                  fmt::format("{}, 2, {}, {}", frames, recon::kCropSide, recon::kCropSide));
  NumpyFile joints(out / "joints.npy", "<f4", fmt::format("{}, {}, 3", frames, recon::kJointCount));
  NumpyFile range(out / "range.npy", "<f4", fmt::format("{},", frames));
  constexpr int64_t kBlock = 1024;  // frames at a time: 20 MB
  std::vector<CropRow> rows(kBlock);
  int64_t people = 0;
  for (int64_t first = 0; first < frames; first += kBlock) {
    const int64_t count = std::min(kBlock, frames - first);
    oneapi::tbb::parallel_for(int64_t{0}, count, [&](int64_t i) {
      if (!options.stop || !options.stop()) {
        ReadRow(reader, first + i, &rows[static_cast<size_t>(i)]);
      }
    });
    if (options.stop && options.stop()) throw TrainInterrupted("interrupted");
    for (int64_t i = 0; i < count; ++i) {
      const CropRow& row = rows[static_cast<size_t>(i)];
      crops.Write(row.cells);
      joints.Write(row.joints);
      range.Write(row.range_m);
      people += row.known ? 1 : 0;
    }
    crops.Check();
    if (options.progress) options.progress(first + count, frames);
  }
  std::filesystem::remove(out / "joints.npy");  // of an earlier run; without it nothing is whole
  crops.Commit();
  range.Commit();
  joints.Commit();
  return people;
}

}  // namespace ossa::tools
