// The same pixels and features for every trainer: tests/bench/trainer_peers calls this.
//   forest_pixels write DATASET FRAMES PIXELS FEATURES OUT   labelled pixels with random features
//   forest_pixels judge DATASET FRAMES PIXELS MODEL          share of such pixels a model has right
// OUT holds int32 rows, int32 features, then rows of int16 responses (millimetres), then one byte
// of label a row. Pixels are drawn as training draws them: equal shares of the classes of an image.
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <random>
#include <string>

#include "depth/base/error.h"
#include "forest/classification/classify.h"
#include "forest/trees/depth_feature_internal.h"
#include "tools/learning/person_source.h"

namespace ossa::tools {
namespace {

constexpr int kBox_units = static_cast<int>(260 * forest::kOffsetUnitsPerPixelMetre);
constexpr uint16_t kBackground_mm = 10000;

struct Feature {
  std::array<int, 4> offset{};  // u, v; offset units
};

std::vector<Feature> DrawFeatures(int count) {
  std::mt19937 random(7);
  std::uniform_int_distribution<int> offset(-kBox_units, kBox_units);
  std::vector<Feature> features(static_cast<size_t>(count));
  for (Feature& feature : features) {
    for (int& value : feature.offset) value = offset(random);
  }
  return features;
}

std::vector<int32_t> ObjectPixels(const forest::TrainingImage& image) {
  std::vector<int32_t> pixels;
  for (size_t i = 0; i < image.label.size(); ++i) {
    if (image.label[i] != 0) pixels.push_back(static_cast<int32_t>(i));
  }
  return pixels;
}

// Indices into `pixels`: about as many of each class.
std::vector<size_t> DrawBalanced(const forest::TrainingImage& image,
                                 const std::vector<int32_t>& pixels, size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<std::vector<size_t>> of_class(256);
  for (size_t i = 0; i < pixels.size(); ++i) {
    of_class[image.label[static_cast<size_t>(pixels[i])]].push_back(i);
  }
  std::erase_if(of_class, [](const auto& list) { return list.empty(); });
  std::vector<size_t> drawn;
  for (auto& list : of_class) {
    std::shuffle(list.begin(), list.end(), random);
    list.resize(std::min(list.size(), count / of_class.size()));
    drawn.insert(drawn.end(), list.begin(), list.end());
  }
  return drawn;
}

// Calls act(image, pixels, drawn) for each frame.
template <typename Act>
void ForFrames(const char* dataset, size_t frames, size_t per_frame, const Act& act) {
  const PersonSource source({dataset}, {0, 100});
  for (size_t i = 0; i < std::min(frames, source.size()); ++i) {
    const forest::TrainingImage image = source.Read(i);
    const std::vector<int32_t> pixels = ObjectPixels(image);
    if (pixels.empty()) continue;
    act(image, pixels, DrawBalanced(image, pixels, per_frame, static_cast<unsigned>(i)));
  }
}

void Write(const char* dataset, size_t frames, size_t per_frame, int count, const char* out) {
  const std::vector<Feature> features = DrawFeatures(count);
  std::vector<int16_t> response;
  std::vector<uint8_t> label;
  ForFrames(dataset, frames, per_frame,
            [&](const auto& image, const auto& pixels, const auto& drawn) {
              const int width = image.camera.width;
              const forest::ObjectImage cut =
                  forest::CutOut({image.depth_mm.data(), width, image.camera.height, width},
                                 image.camera, pixels, kBackground_mm);
              for (const size_t i : drawn) {
                const int x = pixels[i] % width - cut.u0;
                const int y = pixels[i] / width - cut.v0;
                const float d_mm = cut.depth_mm[cut.At(x, y)];
                const auto read = [&](int u, int v) {
                  return cut.depth_mm[static_cast<size_t>(forest::ProbeIndex(
                      x, y, static_cast<float>(u), static_cast<float>(v), cut.scale_u / d_mm,
                      cut.scale_v / d_mm, cut.width, cut.height, cut.stride()))];
                };
                for (const Feature& f : features) {
                  response.push_back(static_cast<int16_t>(read(f.offset[0], f.offset[1]) -
                                                          read(f.offset[2], f.offset[3])));
                }
                label.push_back(image.label[static_cast<size_t>(pixels[i])]);
              }
            });
  std::ofstream file(out, std::ios::binary);
  const std::array<int32_t, 2> size = {static_cast<int32_t>(label.size()), count};
  file.write(reinterpret_cast<const char*>(size.data()), sizeof(size));
  file.write(reinterpret_cast<const char*>(response.data()),
             static_cast<std::streamsize>(2 * response.size()));
  file.write(reinterpret_cast<const char*>(label.data()),
             static_cast<std::streamsize>(label.size()));
}

void Judge(const char* dataset, size_t frames, size_t per_frame, const char* model_path) {
  const forest::ForestModel model = forest::ReadForestModel(model_path);
  size_t right = 0;
  size_t all = 0;
  ForFrames(
      dataset, frames, per_frame, [&](const auto& image, const auto& pixels, const auto& drawn) {
        forest::ClassifyOptions options;
        options.smoothing_m = 0;  // every pixel by itself, once the facing is decided
        options.sample_spacing_m = 0;
        const int width = image.camera.width;
        const forest::Classification result =
            forest::Classify(model, {image.depth_mm.data(), width, image.camera.height, width},
                             image.camera, pixels, options);
        for (const size_t i : drawn) {
          right += result.label[i] == image.label[static_cast<size_t>(pixels[i])] ? 1 : 0;
        }
        all += drawn.size();
      });
  std::printf("%.4f\n", static_cast<double>(right) / static_cast<double>(all));
}

}  // namespace
}  // namespace ossa::tools

int main(int argc, char** argv) {
  const std::string mode = argc > 1 ? argv[1] : "";
  if ((mode != "write" || argc != 7) && (mode != "judge" || argc != 6)) {
    std::fprintf(stderr, "usage: see the top of forest_pixels.cpp\n");
    return 2;
  }
  try {
    const auto number = [&](int i) { return std::strtoul(argv[i], nullptr, 10); };
    if (mode == "write") {
      ossa::tools::Write(argv[2], number(3), number(4), static_cast<int>(number(5)), argv[6]);
    } else {
      ossa::tools::Judge(argv[2], number(3), number(4), argv[5]);
    }
  } catch (const ossa::InputError& error) {
    std::fprintf(stderr, "forest_pixels: %s\n", error.what());
    return 1;
  }
}
