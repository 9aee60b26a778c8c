// OpenSim's TRC marker table: five header lines, then one row per frame, separated by tabs. Markers
// are the 20 joints, camera space, millimetres. Unseen joints are blank, because the format has no
// states; joints without a state count as seen.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <vector>

#include "depth/base/atomic_file.h"
#include "depth/base/one_line.h"
#include "recon/files/skeleton_writer_internal.h"

namespace ossa::recon {
namespace {

namespace fs = std::filesystem;

constexpr double kMillimetresPerMetre = 1000.0;

// Number of frames and time range, which the header states.
struct Extent {
  int64_t frames = 0;
  double first_s = 0.0, last_s = 0.0;

  // The mean rate. OpenSim requires one even if frames were dropped (the Time column is exact).
  double Rate_Hz() const {
    constexpr double kUsualRate_Hz = 30.0;  // by convention, a Kinect SDK's rate
    const double span_s = last_s - first_s;
    if (frames < 2 || !(span_s > 0)) return kUsualRate_Hz;
    return static_cast<double>(frames - 1) / span_s;
  }
};

// The header, with `spaces` trailing spaces on its third line, which readers ignore.
std::string Header(const Extent& extent, const fs::path& path, size_t spaces = 0) {
  std::string text = "PathFileType\t4\t(X/Y/Z)\t" + OnOneLine(path.filename().string()) +
                     "\nDataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\t"
                     "OrigDataStartFrame\tOrigNumFrames\n";
  text += fmt::format("{0:.3f}\t{0:.3f}\t{1}\t{2}\tmm\t{0:.3f}\t1\t{1}", extent.Rate_Hz(),
                      extent.frames, kJointCount);
  text += std::string(spaces, ' ') + "\nFrame#\tTime";
  for (const std::string_view name : kJointNames) text += fmt::format("\t{}\t\t", name);
  text += "\n\t";
  for (int j = 1; j <= kJointCount; ++j) text += fmt::format("\tX{0}\tY{0}\tZ{0}", j);
  return text + "\n\n";
}

std::string Row(int64_t number, double time_s, const BodyRecord* body) {
  std::string row = fmt::format("{}\t{:.6f}", number, time_s);
  for (size_t j = 0; j < kJointCount; ++j) {
    if (body == nullptr || !body->joints[j] || !HasPlace(*body->joints[j])) {
      row += "\t\t\t";
      continue;
    }
    for (const double value : body->joints[j]->position_m) {
      row += fmt::format("\t{:.4f}", value * kMillimetresPerMetre);
    }
  }
  return row + '\n';
}

// One person's table, written incrementally. Space is reserved in the header for its final values;
// what is unused is removed at the end.
class MarkerTable {
 public:
  MarkerTable(const fs::path& path, std::optional<int> id) : id_(id), path_(path), file_(path) {
    const std::string header = Header({}, path_, kRoom);
    room_ = header.size();
    file_.stream() << header;
    file_.Flush();
    end_ = room_;
  }

  std::optional<int> id() const { return id_; }
  void set_id(int id) { id_ = id; }

  void Append(const std::string& row) {
    file_.stream() << row;
    written_ += row.size();
  }
  void Flush() { file_.Flush(); }
  /// Marks what was appended and flushed as kept.
  void Keep() {
    end_ += written_;
    written_ = 0;
  }
  /// Discards what was appended since Keep.
  void Cut() { file_.CutTo(end_); }
  void Finish(const Extent& extent) {
    const std::string header = Header(extent, path_);
    file_.stream().seekp(0);
    file_.stream() << header;
    file_.RemoveBytes(header.size(), room_ - header.size());
    file_.Commit();
  }

 private:
  // Two counts and three rates, with the maximum digits of a double: bytes, derived from the format
  // of a double.
  static constexpr size_t kRoom = 1100;

  std::optional<int> id_;
  fs::path path_;
  AtomicFile file_;
  size_t room_ = 0;
  uint64_t end_ = 0;      // end of the kept part
  uint64_t written_ = 0;  // end of the written part
};

class TrcWriter final : public SkeletonWriter::Format {
 public:
  explicit TrcWriter(fs::path path) : path_(std::move(path)) {
    tables_.push_back(std::make_unique<MarkerTable>(path_, std::nullopt));
  }

  void Write(const SkeletonFrame& frame) override {
    for (const BodyRecord& body : frame.bodies) RequireTable(body.id);
    const auto number = static_cast<int64_t>(times_s_.size()) + 1;
    for (const auto& table : tables_) {
      const auto body = std::find_if(frame.bodies.begin(), frame.bodies.end(),
                                     [&](const auto& b) { return b.id == table->id(); });
      table->Append(Row(number, frame.time_s, body == frame.bodies.end() ? nullptr : &*body));
    }
    // All tables keep the frame, or none does.
    for (const auto& table : tables_) table->Flush();
    for (const auto& table : tables_) table->Keep();
    times_s_.push_back(frame.time_s);
  }

  void Finish() override {
    for (const auto& table : tables_) table->Finish(ExtentSoFar());
  }

  int64_t FinishWithWhatFits() override {
    if (times_s_.empty()) return 0;
    for (const auto& table : tables_) table->Cut();
    Finish();
    return static_cast<int64_t>(times_s_.size());
  }

 private:
  // The first person seen gets the first table. Tables of later people start with blank rows.
  void RequireTable(int id) {
    for (const auto& table : tables_) {
      if (!table->id()) table->set_id(id);
      if (table->id() == id) return;
    }
    auto table = std::make_unique<MarkerTable>(PathForBody(path_, tables_.size(), id), id);
    for (size_t f = 0; f < times_s_.size(); ++f) {
      table->Append(Row(static_cast<int64_t>(f) + 1, times_s_[f], nullptr));
    }
    table->Flush();
    table->Keep();
    tables_.push_back(std::move(table));
  }

  Extent ExtentSoFar() const {
    if (times_s_.empty()) return {};
    return {static_cast<int64_t>(times_s_.size()), times_s_.front(), times_s_.back()};
  }

  fs::path path_;
  std::vector<double> times_s_;
  std::vector<std::unique_ptr<MarkerTable>> tables_;
};

}  // namespace

std::unique_ptr<SkeletonWriter::Format> NewTrcWriter(const fs::path& path) {
  return std::make_unique<TrcWriter>(path);
}

}  // namespace ossa::recon
