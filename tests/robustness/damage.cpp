#include "tests/robustness/damage.h"

#include <fstream>

#include "depth/base/error.h"
#include "tests/support/temporary_folder.h"

namespace ossa::test {
namespace {

// Writes damaged copies in the sample's place, reads them and counts.
class Trial {
 public:
  explicit Trial(const DamageSample& sample)
      : sample_(sample), path_(folder_ / sample.name), whole_(Read(sample.bytes).content) {}

  void Try(const std::string& bytes, const std::string& what) {
    ++outcomes_.tried;
    try {
      const Reading reading = Read(bytes);
      if (reading.content == whole_) {
        ++outcomes_.same;
      } else if (reading.warned) {
        ++outcomes_.warned;
      } else if (++outcomes_.silent == 1) {
        outcomes_.first_silent = what;
      }
    } catch (const InputError&) {
      ++outcomes_.refused;
    }
  }
  const DamageOutcomes& outcomes() const { return outcomes_; }

 private:
  Reading Read(const std::string& bytes) {
    std::ofstream(path_, std::ios::binary) << bytes;
    return sample_.read(path_);
  }

  const DamageSample& sample_;
  TemporaryFolder folder_;
  std::filesystem::path path_;
  DamageOutcomes outcomes_;
  std::string whole_;
};

}  // namespace

void AppendFrame(const depth::DepthFrame& frame, std::string* content) {
  content->append(reinterpret_cast<const char*>(frame.depth_mm.data()),
                  frame.depth_mm.size() * sizeof(uint16_t));
  *content += std::to_string(frame.time_s) + " " + std::to_string(frame.camera.fx);
}

DamageOutcomes CutShort(const DamageSample& sample, size_t step) {
  Trial trial(sample);
  for (size_t size = 0; size < sample.bytes.size(); size += step) {
    trial.Try(sample.bytes.substr(0, size), "cut to " + std::to_string(size) + " bytes");
  }
  return trial.outcomes();
}

DamageOutcomes FlipBits(const DamageSample& sample, size_t step) {
  Trial trial(sample);
  for (size_t bit = 0; bit < 8 * sample.bytes.size(); bit += step) {
    std::string bytes = sample.bytes;
    bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ (1 << bit % 8));
    trial.Try(bytes, "byte " + std::to_string(bit / 8) + ", bit " + std::to_string(bit % 8));
  }
  return trial.outcomes();
}

}  // namespace ossa::test
