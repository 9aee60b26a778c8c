#include <algorithm>
#include <deque>
#include <exception>
#include <functional>
#include <iomanip>
#include <sstream>
#include <string>
#include <utility>

#include "depth/base/error.h"
#include "depth/sensor/depth_census.h"
#include "depth/sensor/depth_coding.h"
#include "depth/sensor/source_internal.h"

namespace ossa::depth {
namespace {

// Wraps a recording or a stream: converts its values to millimetres and its indices to times.
class PreparedSource final : public FrameSource {
 public:
  PreparedSource(std::string name, std::unique_ptr<FrameSource> source,
                 const SourceOptions& options)
      : name_(std::move(name)),
        source_(std::move(source)),
        fps_(options.fps),
        note_(options.note),
        keep_waiting_(options.keep_waiting) {
    const DepthCoding coding{options.depth_format, options.depth_scale.value_or(1000.0),
                             options.inverted_from};
    if (!coding.IsMillimetres()) table_ = MillimetreTable(coding);
  }

  void RefuseOtherUnits() {
    DepthCensus census;
    try {
      LookAhead(census);
    } catch (const InputError&) {
      if (ahead_.empty()) throw;
      damage_ = std::current_exception();
    }
    const auto suspicion = census.Judge();
    if (!suspicion) return WarnOfFarDepths(census);
    const std::string reads =
        suspicion->option.empty() ? "" : suspicion->option + " reads them so; ";
    throw InputError(name_ + ": expected depths in millimetres, found what looks like " +
                     suspicion->looks + " (" + reads +
                     "--depth-scale 1000 takes them as they are)");
  }

  ReadResult Read(std::chrono::milliseconds timeout) override {
    ReadResult read = Next(timeout);
    if (read.status != ReadStatus::kFrame) return read;
    ToMillimetres(read.frame.depth_mm);
    if (!first_index_) first_index_ = read.frame.index;
    if (fps_) read.frame.time_s = static_cast<double>(read.frame.index - *first_index_) / *fps_;
    return read;
  }
  const Camera& camera() const override { return source_->camera(); }
  bool is_live() const override { return source_->is_live(); }
  std::optional<int64_t> frame_count() const override { return source_->frame_count(); }

 private:
  void WarnOfFarDepths(const DepthCensus& census) const {
    const auto median_m = census.FindFarMedian_m();
    if (!median_m || !note_) return;
    std::ostringstream text;
    text << name_ << ": as millimetres half of the depths lie beyond " << std::setprecision(2)
         << *median_m
         << " m, where nobody is tracked: if they are fifths of a millimetre (Orbbec), "
            "--depth-scale 5000; halves, 2000; quarters, 4000; tenths, 10000";
    note_(NoteKind::kWarning, text.str());
  }

  // Examines the first non-empty frames: of a recording 0.1 s or, where they show little, 1 s at 30
  // Hz; of a stream no more than come soon, because whoever watches waits. Constants: by hand.
  void LookAhead(DepthCensus& census) {
    constexpr size_t kEnoughFrames = 3, kMostFrames = 30;
    constexpr int kLongestPause = 10;  // tenths of a second
    const size_t most = is_live() ? kEnoughFrames : kMostFrames;
    int pause = 0;
    while (ahead_.size() < most && (ahead_.size() < kEnoughFrames || !census.IsEnough())) {
      ReadResult read = source_->Read(std::chrono::milliseconds(100));
      pause = read.status == ReadStatus::kTimeout ? pause + 1 : 0;
      const bool is_ended = pause > 0 && keep_waiting_ && !keep_waiting_();
      if (is_ended || (is_live() && pause == kLongestPause)) break;
      if (read.status == ReadStatus::kFrame) census.Add(read.frame.view());
      const bool ended = read.status == ReadStatus::kEnd;
      if (read.status == ReadStatus::kFrame || ended) ahead_.push_back(std::move(read));
      if (ended) break;
    }
  }

  void ToMillimetres(std::vector<uint16_t>& depths) const {
    if (table_.empty()) {
      std::replace(depths.begin(), depths.end(), kSaturatedDepth, uint16_t{0});
    } else {
      for (uint16_t& depth : depths) depth = table_[depth];
    }
  }

  ReadResult Next(std::chrono::milliseconds timeout) {
    if (ahead_.empty() && damage_) std::rethrow_exception(std::exchange(damage_, nullptr));
    if (ahead_.empty()) return source_->Read(timeout);
    ReadResult read = std::move(ahead_.front());
    ahead_.pop_front();
    return read;
  }

  std::string name_;
  std::unique_ptr<FrameSource> source_;
  std::optional<double> fps_;
  std::function<void(NoteKind, const std::string&)> note_;  // may be empty
  std::function<bool()> keep_waiting_;                      // may be empty
  std::vector<uint16_t> table_;  // millimetres of each value; empty: identity
  std::deque<ReadResult> ahead_;
  std::exception_ptr damage_;  // thrown after these frames
  std::optional<int64_t> first_index_;
};

}  // namespace

std::unique_ptr<FrameSource> Prepared(const std::string& name, std::unique_ptr<FrameSource> source,
                                      UnitStated unit, const SourceOptions& options) {
  const bool asked = options.depth_scale || options.depth_format != DepthFormat::kPlain;
  if (source->is_live() && unit == UnitStated::kYes) {
    if (asked || options.fps) {
      throw InputError(name +
                       ": expected a recording for --depth-scale, --depth-format and --fps, "
                       "found a device, which states its units and times");
    }
    return source;
  }
  auto prepared = std::make_unique<PreparedSource>(name, std::move(source), options);
  if (unit == UnitStated::kNo && !asked) prepared->RefuseOtherUnits();
  return prepared;
}

}  // namespace ossa::depth
