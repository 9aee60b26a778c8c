// ossa_array_reader FILE NAME: writes the depth images of a file of arrays (.npy, .npz, .mat, .h5)
// to standard output; NAME "" takes the array that is named after depth (array_stack.h).
#include <cstring>
#include <new>

#include "depth/base/error.h"
#include "depth/base/lower_case.h"
#include "depth/sensor/frame_names.h"
#include "depth/sensor/readers/arrays/array_stack.h"
#include "depth/sensor/readers/reader_pipe_internal.h"

namespace ossa::depth {
namespace {

namespace fs = std::filesystem;

constexpr double kFramePeriod_s = 1.0 / 30.0;  // without times: by convention the Kinect's rate

std::unique_ptr<ArrayFile> OpenArrays(const fs::path& path) {
  const std::string extension = LowerCaseExtension(path);
  if (extension == ".npy") return OpenNpy(path);
  if (extension == ".npz") return OpenNpz(path);
  if (extension == ".mat" && !IsHdf5(path)) return OpenMat(path);
  return OpenHdf5(path);
}

// The images of a stack, one by one, row-major.
class StackReader {
 public:
  StackReader(ArrayFile& file, const ArrayStack& stack) : file_(file), stack_(stack) {}

  std::vector<uint8_t> Read(size_t frame) {
    const std::vector<uint8_t> slice = ReadSlice(frame);
    const auto width = static_cast<size_t>(stack_.width),
               height = static_cast<size_t>(stack_.height);
    const auto size = static_cast<size_t>(stack_.format().size);
    const std::vector<uint8_t>& from = stack_.IsSliced() ? slice : whole_;
    const size_t begin = stack_.IsSliced() ? 0 : frame * stack_.step[0];
    if (stack_.IsSliced() && stack_.step[2] == 1) return slice;
    std::vector<uint8_t> image(width * height * size);
    for (size_t y = 0; y < height; ++y) {
      for (size_t x = 0; x < width; ++x) {
        std::memcpy(&image[(y * width + x) * size],
                    &from[(begin + y * stack_.step[1] + x * stack_.step[2]) * size], size);
      }
    }
    return image;
  }

 private:
  // Of the file what this image is; all of it, kept, if images are not slices.
  std::vector<uint8_t> ReadSlice(size_t frame) {
    const ArrayInfo& first = stack_.arrays.front();
    if (stack_.arrays.size() > 1) {
      const ArrayInfo& array = stack_.arrays[frame];
      return file_.Read(array, 0, array.SliceCount());
    }
    if (first.shape.size() == 2) return file_.Read(first, 0, first.SliceCount());
    if (stack_.IsSliced()) return file_.Read(first, frame, 1);
    if (whole_.empty()) whole_ = ReadWhole(first);
    return {};
  }

  std::vector<uint8_t> ReadWhole(const ArrayInfo& array) {
    constexpr size_t kMost = size_t{1} << 30;  // bytes, by hand: half of the reader's memory
    if (array.SliceCount() > kMost / std::max<size_t>(array.SliceBytes(), 1)) {
      throw InputError(
          array.name +
          ": too large to be read at once, and its images are not one after the other: "
          "store it as images x height x width");
    }
    return file_.Read(array, 0, array.SliceCount());
  }

  ArrayFile& file_;
  const ArrayStack& stack_;
  std::vector<uint8_t> whole_;
};

// Millimetres per unit of floats, by the first image with readings; none for integers.
std::optional<double> FindUnit_mm(StackReader& reader, const ArrayStack& stack) {
  constexpr size_t kMost = 30;  // images, by hand: a second
  if (stack.format().kind != NumberKind::kFloat) return std::nullopt;
  for (size_t i = 0; i < std::min(stack.count, kMost); ++i) {
    if (const auto unit_mm = GuessUnit_mm(stack.format(), reader.Read(i))) return unit_mm;
  }
  return std::nullopt;
}

// Times of the images from the first one; empty if the file states none.
std::vector<double> ReadTimes(ArrayFile& file, const ArrayStack& stack) {
  const std::vector<ArrayInfo> arrays = FindTimes(file.List(), stack.count);
  if (arrays.empty() || stack.count < 2) return {};
  const std::string& name = arrays.front().name;
  std::vector<double> times, steps;
  for (const ArrayInfo& array : arrays) {
    const auto values = ValuesOf(array.format, file.Read(array, 0, array.SliceCount()));
    times.insert(times.end(), values.begin(), values.end());
  }
  for (size_t i = 1; i < times.size(); ++i) steps.push_back(times[i] - times[i - 1]);
  const auto middle = steps.begin() + static_cast<ptrdiff_t>(steps.size() / 2);
  const bool is_rising =
      std::all_of(steps.begin(), steps.end(), [](double step) { return step >= 0; });
  std::nth_element(steps.begin(), middle, steps.end());
  if (!is_rising || !(*middle > 0)) {
    SendText(ReaderKind::kNote, name + " does not rise as times do: ignored");
    return {};
  }
  const double unit_s = GuessTimeUnit(*middle).value_or(1.0);
  const double first = times.front();
  for (double& time : times) time = (time - first) * unit_s;
  SendText(ReaderKind::kNote, "times are those of " + name + ", in " +
                                  (unit_s == 1.0    ? "seconds"
                                   : unit_s == 1e-3 ? "milliseconds"
                                   : unit_s == 1e-6 ? "microseconds"
                                                    : "nanoseconds"));
  return times;
}

std::optional<Camera> ReadCamera(ArrayFile& file, const ArrayStack& stack) {
  const std::vector<ArrayInfo> arrays = file.List();
  const ArrayInfo* array = FindCameraMatrix(arrays);
  if (array == nullptr) return std::nullopt;
  const auto camera =
      CameraOfMatrix(ValuesOf(array->format, file.Read(*array, 0, 3)), stack.width, stack.height);
  SendText(ReaderKind::kNote,
           "the camera is that of " + array->name +
               (camera ? "" : ", which is no matrix of a camera of such images: ignored"));
  return camera;
}

void SendStack(ArrayFile& file, const std::string& asked) {
  const ArrayStack stack = ChooseStack(file.List(), asked);
  StackReader reader(file, stack);
  const auto unit_mm = FindUnit_mm(reader, stack);
  ReaderHello hello;
  hello.camera.width = stack.width;
  hello.camera.height = stack.height;
  if (const auto camera = ReadCamera(file, stack)) {
    hello.camera = *camera;
    hello.is_camera_stated = true;
  }
  hello.is_unit_stated = unit_mm == 1000.0;
  hello.frame_count = static_cast<int64_t>(stack.count);
  SendText(ReaderKind::kNote,
           stack.Describe() + (hello.is_unit_stated ? " in metres" : "") +
               (stack.frame_axis != 0 ? ", counted by the dimension at the other end" : ""));
  const std::vector<double> times = ReadTimes(file, stack);
  SendHello(hello);
  for (size_t i = 0; i < stack.count; ++i) {
    const ReaderFrame head{stack.width, stack.height,
                           times.empty() ? static_cast<double>(i) * kFramePeriod_s : times[i], 0};
    SendFrame(head, DepthsOf(stack.format(), reader.Read(i), unit_mm.value_or(1.0)));
  }
}

void ReadArrays(const fs::path& path, const std::string& asked) {
  try {
    const auto file = OpenArrays(path);
    SendStack(*file, asked);
  } catch (const std::bad_alloc&) {
    throw InputError("out of memory: expected images that fit into it");
  }
}

}  // namespace
}  // namespace ossa::depth

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  ossa::depth::RunReader([&] { ossa::depth::ReadArrays(argv[1], argv[2]); });
}
