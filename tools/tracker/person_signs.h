#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "depth/image/depth_frame.h"

namespace ossa::tracker {

/// What a piece of the scene looks like to the forest: what people are told from furniture by.
struct CandidateSigns {
  std::vector<int32_t> pixels;  // v * width + u, ascending
  std::vector<double> signs;    // one for each of PersonSignNames()
  double score = 0.0;           // what the shipped weights make of them
};

std::span<const std::string_view> PersonSignNames();
/// So many of the first signs are known before joints are proposed.
size_t SurfaceSignCount();

/// Looks at every piece of single frames, as the tracker does: for fitting and judging the weights.
class SignCollector {
 public:
  /// Throws InputError naming the model; "" is the shipped one.
  explicit SignCollector(const std::filesystem::path& model);
  ~SignCollector();
  std::vector<CandidateSigns> Look(const depth::DepthFrame& frame) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace ossa::tracker
