// Arrays of NumPy, MATLAB and HDF5 as recordings: which array, in which order, which unit, camera
// and times.
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "depth/sensor/frame_source.h"
#include "depth/sensor/readers/arrays/array_stack.h"
#include "tests/depth/sensor/array_writer.h"
#include "tests/depth/sensor/folder_frames.h"
#include "tests/depth/sensor/frames_of.h"
#include "tests/support/refused.h"
#include "tests/support/temporary_folder.h"

namespace ossa::depth {
namespace {

using test::ExpectRefused;
using test::FramesOf;
using test::Hdf5Writer;
using test::MatWriter;
using test::Notes;
using test::NpyBytes;
using test::Shape;
using test::TemporaryFolder;
using test::WriteBytes;
using test::WriteNpz;

constexpr size_t kImages = 3, kHeight = 18, kWidth = 24;
const Shape kShape = {kImages, kHeight, kWidth};

// Millimetres that differ in every pixel, row by row, image by image.
uint16_t DepthAt(size_t image, size_t y, size_t x) {
  return static_cast<uint16_t>(1000 + 700 * image + 31 * y + x);
}

// The depths in the order of three nested loops: 'f'rame, 'r'ow and 'c'olumn, the last innermost.
template <typename T>
std::vector<T> Numbers(const std::string& order = "frc", double scale = 1.0) {
  const auto length = [](char axis) {
    return axis == 'f' ? kImages : axis == 'r' ? kHeight : kWidth;
  };
  std::vector<T> numbers;
  for (size_t i = 0; i < length(order[0]); ++i) {
    for (size_t j = 0; j < length(order[1]); ++j) {
      for (size_t k = 0; k < length(order[2]); ++k) {
        const auto at = [&](char axis) { return axis == order[0] ? i : axis == order[1] ? j : k; };
        numbers.push_back(static_cast<T>(DepthAt(at('f'), at('r'), at('c')) * scale));
      }
    }
  }
  return numbers;
}

// Expects the images of Numbers(), `images` of them from `first` on.
std::vector<DepthFrame> ExpectImages(const std::string& source, size_t images = kImages,
                                     size_t first = 0, const SourceOptions& options = {}) {
  const auto opened = OpenSource(source, options);
  EXPECT_EQ(opened->frame_count(), static_cast<int64_t>(images)) << source;
  std::vector<DepthFrame> frames = FramesOf(*opened);
  EXPECT_EQ(frames.size(), images) << source;
  for (size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i].camera.width, static_cast<int>(kWidth)) << source;
    const std::vector<uint16_t> all = Numbers<uint16_t>();
    const auto begin = all.begin() + static_cast<ptrdiff_t>((first + i) * kHeight * kWidth);
    const std::vector<uint16_t> expected(begin, begin + static_cast<ptrdiff_t>(kHeight * kWidth));
    EXPECT_EQ(frames[i].depth_mm, expected) << source << " image " << i;
  }
  return frames;
}

TEST(NumpyArrays, OfAnyTypeAndOrderHaveTheSameImages) {
  const TemporaryFolder folder;
  const auto expect = [&](const std::string& bytes) {
    WriteBytes(folder / "x.npy", bytes);
    ExpectImages(folder / "x.npy");
  };
  expect(NpyBytes("<u2", kShape, Numbers<uint16_t>()));
  expect(NpyBytes("<i4", kShape, Numbers<int32_t>()));
  expect(NpyBytes("<i8", kShape, Numbers<int64_t>()));
  expect(NpyBytes("<f4", kShape, Numbers<float>("frc", 1e-3)));  // metres
  expect(NpyBytes("<f8", kShape, Numbers<double>()));            // millimetres
  expect(NpyBytes("<u2", {kImages, kHeight, kWidth, 1}, Numbers<uint16_t>()));
  expect(NpyBytes("<u2", {kHeight, kWidth, kImages}, Numbers<uint16_t>("rcf")));
  expect(NpyBytes("<u2", kShape, Numbers<uint16_t>("crf"), true));
  std::vector<uint16_t> swapped = Numbers<uint16_t>();
  for (uint16_t& number : swapped) number = static_cast<uint16_t>(number << 8 | number >> 8);
  expect(NpyBytes(">u2", kShape, swapped));
}

TEST(NumpyArrays, OfOneImageAreAStill) {
  const TemporaryFolder folder;
  const std::vector<uint16_t> all = Numbers<uint16_t>();
  const std::vector<uint16_t> one(all.begin(), all.begin() + kHeight * kWidth);
  WriteBytes(folder / "x.npy", NpyBytes("<u2", {kHeight, kWidth}, one));
  ExpectImages(folder / "x.npy", 1);
}

TEST(NumpyArrays, HaveTheCameraOfTheirFolderAndThirtyImagesASecond) {
  const TemporaryFolder folder;
  WriteBytes(folder / "x.npy", NpyBytes("<u2", kShape, Numbers<uint16_t>()));
  WriteBytes(folder / "camera.json",
             R"({"width": 24, "height": 18, "fx": 33, "fy": 34, "cx": 12, "cy": 9})");
  const auto frames = ExpectImages(folder / "x.npy");
  EXPECT_EQ(frames.front().camera.fx, 33);
  EXPECT_NEAR(frames.back().time_s, 2 / 30.0, 1e-9);
}

TEST(NumpyArrays, OfWhatIsNoDepthAreRefused) {
  const TemporaryFolder folder;
  const auto expect = [&](const std::string& bytes, const std::string& named) {
    WriteBytes(folder / "x.npy", bytes);
    ExpectRefused([&] { OpenSource(folder / "x.npy"); }, named);
  };
  const std::string sound = NpyBytes("<u2", kShape, Numbers<uint16_t>());
  expect("", "expected a NumPy array");
  expect(sound.substr(0, 60), "header is cut short");
  expect(NpyBytes("|O", {3}, Numbers<uint16_t>()), "found ''|O''");
  expect(NpyBytes("<c8", kShape, Numbers<uint16_t>()), "integers or floats");
  expect(NpyBytes("|u1", kShape, Numbers<uint8_t>()), "none among its 1 arrays");
  expect(NpyBytes("<u2", {5}, Numbers<uint16_t>()), "none among its 1 arrays");
  expect(NpyBytes("<u2", {0, kHeight, kWidth}, Numbers<uint16_t>()), "no array of numbers");
  expect(NpyBytes("<u2", {size_t{1} << 40, size_t{1} << 40}, Numbers<uint16_t>()), "none among");
}

TEST(NumpyArrays, ThatWereCutShortGiveTheImagesBefore) {
  const TemporaryFolder folder;
  const std::string sound = NpyBytes("<u2", kShape, Numbers<uint16_t>());
  WriteBytes(folder / "x.npy", sound.substr(0, sound.size() - 10));
  const auto source = OpenSource(folder / "x.npy");
  EXPECT_EQ(source->Read(std::chrono::seconds(1)).status, ReadStatus::kFrame);
  EXPECT_EQ(source->Read(std::chrono::seconds(1)).status, ReadStatus::kFrame);
  ExpectRefused([&] { source->Read(std::chrono::seconds(1)); }, "cut short in image 2");
}

TEST(NumpyArrays, BesideImagesAreIgnoredIfTheyAreSmall) {
  const TemporaryFolder folder;
  test::WriteFrame(folder / "0.png", 1000);
  WriteBytes(folder / "K.npy", NpyBytes("<f8", {3, 3}, std::vector<double>(9, 1)));
  WriteBytes(folder / "poses.npy", NpyBytes("<f8", {40, 7}, std::vector<double>(280, 1)));
  Notes notes;
  EXPECT_EQ(test::ValuesOf(*OpenSource(folder.path(), notes.Options())),
            (std::vector<uint16_t>{1000}));
  EXPECT_TRUE(notes.Tell("2 files are not depth images and are ignored: K.npy, poses.npy"));
  EXPECT_TRUE(IsRecording(folder.path()));
  std::filesystem::remove(folder / "0.png");
  WriteBytes(folder / "walk.bvh", "HIERARCHY");
  EXPECT_FALSE(IsRecording(folder.path())) << "but skeletons";
}

TEST(NumpyArchives, HaveDepthTimesAndCameraByTheirNames) {
  const TemporaryFolder folder;
  const std::vector<double> matrix = {33, 0, 12, 0, 34, 9, 0, 0, 1};
  const std::vector<double> times = {1714568398.0, 1714568398.1, 1714568398.3};
  for (const bool is_compressed : {false, true}) {
    WriteNpz(folder / "x.npz",
             {{"rgb", NpyBytes("|u1", {kImages, 4, 4, 3}, std::vector<uint8_t>(kImages * 48))},
              {"ir", NpyBytes("<u2", kShape, Numbers<uint16_t>("frc", 2))},
              {"depth", NpyBytes("<u2", kShape, Numbers<uint16_t>())},
              {"timestamps", NpyBytes("<f8", {kImages}, times)},
              {"K", NpyBytes("<f8", {3, 3}, matrix)},
              {"names", NpyBytes("<U5", {3}, std::vector<uint32_t>(15))}},
             is_compressed);
    Notes notes;
    const auto frames = ExpectImages(folder / "x.npz", kImages, 0, notes.Options());
    EXPECT_EQ(frames.front().camera.fy, 34);
    EXPECT_EQ(frames.front().camera.cy, 9);
    EXPECT_NEAR(frames.back().time_s, 0.3, 1e-6);
    EXPECT_TRUE(notes.Tell("depth, 3 images of 24x18, uint16"));
    EXPECT_TRUE(notes.Tell("times are those of timestamps, in seconds"));
    EXPECT_TRUE(notes.Tell("the camera is that of K"));
  }
}

TEST(NumpyArchives, OfOneArrayAnImageAreASequence) {
  const TemporaryFolder folder;
  const std::vector<uint16_t> all = Numbers<uint16_t>();
  std::vector<std::pair<std::string, std::string>> arrays;
  for (size_t i = 0; i < kImages; ++i) {
    const auto begin = all.begin() + static_cast<ptrdiff_t>(i * kHeight * kWidth);
    const std::vector<uint16_t> one(begin, begin + static_cast<ptrdiff_t>(kHeight * kWidth));
    arrays.push_back({"arr_" + std::to_string(9 + i), NpyBytes("<u2", {kHeight, kWidth}, one)});
  }
  WriteNpz(folder / "x.npz", arrays, true);
  ExpectImages(folder / "x.npz");
  ExpectImages(folder / "x.npz#arr_10", 1, 1);
}

TEST(NumpyArchives, OfSeveralStacksNeedAName) {
  const TemporaryFolder folder;
  WriteNpz(folder / "x.npz",
           {{"a", NpyBytes("<u2", kShape, Numbers<uint16_t>())},
            {"b", NpyBytes("<u2", kShape, Numbers<uint16_t>())}},
           false);
  ExpectRefused([&] { OpenSource(folder / "x.npz"); }, "name one, as in FILE#a");
  ExpectRefused([&] { OpenSource((folder / "x.npz").string() + "#c"); }, "expected images in 'c'");
  ExpectImages((folder / "x.npz").string() + "#b");
}

TEST(MatFiles, OfAnyTypeHaveTheirImages) {
  const TemporaryFolder folder;
  const Shape shape = {kHeight, kWidth, kImages};
  for (const auto compression : {MAT_COMPRESSION_NONE, MAT_COMPRESSION_ZLIB}) {
    MatWriter(folder / "x.mat")
        .Add("label", MAT_C_DOUBLE, MAT_T_DOUBLE, {1, 1}, std::vector<double>{7}, compression)
        .Add("d_depth", MAT_C_UINT16, MAT_T_UINT16, shape, Numbers<uint16_t>("fcr"), compression);
    ExpectImages(folder / "x.mat");
    MatWriter(folder / "x.mat")
        .Add("D", MAT_C_DOUBLE, MAT_T_DOUBLE, shape, Numbers<double>("fcr", 1e-3), compression);
    ExpectImages(folder / "x.mat");
    MatWriter(folder / "x.mat")  // images first
        .Add("D", MAT_C_SINGLE, MAT_T_SINGLE, kShape, Numbers<float>("crf"), compression);
    ExpectImages(folder / "x.mat");
  }
}

// Each image apart, as MATLAB has it.
std::vector<std::vector<uint16_t>> MatlabImages() {
  std::vector<std::vector<uint16_t>> images;
  const std::vector<uint16_t> all = Numbers<uint16_t>("fcr");
  for (size_t i = 0; i < kImages; ++i) {
    const auto begin = all.begin() + static_cast<ptrdiff_t>(i * kHeight * kWidth);
    images.emplace_back(begin, begin + static_cast<ptrdiff_t>(kHeight * kWidth));
  }
  return images;
}

TEST(MatFiles, HaveWhatIsInsideOfCellsAndStructs) {
  const TemporaryFolder folder;
  const Shape image = {kHeight, kWidth}, stack = {kHeight, kWidth, kImages};
  for (const auto compression : {MAT_COMPRESSION_NONE, MAT_COMPRESSION_ZLIB}) {
    MatWriter(folder / "x.mat")
        .AddCells("depth", MAT_C_UINT16, MAT_T_UINT16, image, MatlabImages(), compression)
        .AddCells("other", MAT_C_UINT16, MAT_T_UINT16, image, MatlabImages(), compression);
    ExpectImages(folder / "x.mat");
    ExpectImages((folder / "x.mat").string() + "#other");
    MatWriter(folder / "x.mat")
        .AddStructs("frames", MAT_C_UINT16, MAT_T_UINT16, image, MatlabImages(), compression);
    EXPECT_EQ(ExpectImages(folder / "x.mat").back().time_s, 0.5) << "by their fields t";
    ExpectImages((folder / "x.mat").string() + "#frames.depth");
    MatWriter(folder / "x.mat")
        .AddStructs("s", MAT_C_UINT16, MAT_T_UINT16, stack,
                    std::vector<std::vector<uint16_t>>{Numbers<uint16_t>("fcr")}, compression);
    ExpectImages(folder / "x.mat");
    ExpectImages((folder / "x.mat").string() + "#s.depth");
  }
}

TEST(MatFiles, ThatAreDamagedAreRefused) {
  const TemporaryFolder folder;
  MatWriter(folder / "x.mat")
      .Add("d_depth", MAT_C_UINT16, MAT_T_UINT16, {kHeight, kWidth, kImages},
           Numbers<uint16_t>("fcr"));
  std::ifstream file(folder / "x.mat", std::ios::binary);
  const std::string sound{std::istreambuf_iterator<char>(file), {}};
  const auto expect = [&](const std::string& bytes, const std::string& named) {
    WriteBytes(folder / "y.mat", bytes);
    ExpectRefused([&] { OpenSource(folder / "y.mat"); }, named);
  };
  expect(sound.substr(0, sound.size() - 1), "variable 1: cut short");
  expect(sound.substr(0, 100), "expected a MAT file");
  expect("x", "expected a MAT file");
  std::string flipped = sound;
  flipped[sound.size() / 2] = static_cast<char>(flipped[sound.size() / 2] ^ 4);
  expect(flipped, "compressed numbers are damaged");
}

TEST(Hdf5Files, HaveTheirDataSetsInAnyGroup) {
  const TemporaryFolder folder;
  const std::vector<int64_t> times = {1'000'000, 1'033'000, 1'066'000};
  Hdf5Writer(folder / "x.h5")
      .Add("camera/depth", H5T_STD_U16LE, kShape, Numbers<uint16_t>())
      .Add("camera/infrared", H5T_STD_U16LE, kShape, Numbers<uint16_t>())
      .Add("camera/time", H5T_STD_I64LE, {kImages}, times);
  const auto frames = ExpectImages(folder / "x.h5");
  EXPECT_NEAR(frames.back().time_s, 0.066, 1e-6);
}

TEST(Hdf5Files, OfOneDataSetAnImageAreASequence) {
  const TemporaryFolder folder;
  const std::vector<float> all = Numbers<float>("frc", 1e-3);
  {
    Hdf5Writer writer(folder / "x.hdf5");
    for (size_t i = 0; i < kImages; ++i) {
      const auto begin = all.begin() + static_cast<ptrdiff_t>(i * kHeight * kWidth);
      const std::vector<float> one(begin, begin + static_cast<ptrdiff_t>(kHeight * kWidth));
      writer.Add("depth/" + std::to_string(9 + i), H5T_IEEE_F32LE, {kHeight, kWidth}, one);
      writer.Add("amplitude/" + std::to_string(9 + i), H5T_IEEE_F32LE, {kHeight, kWidth}, one);
    }
  }
  ExpectImages(folder / "x.hdf5");
  ExpectImages((folder / "x.hdf5").string() + "#amplitude");
}

TEST(Hdf5Files, OfMatlabHaveItsOrder) {
  const TemporaryFolder folder;
  Hdf5Writer(folder / "x.mat")
      .Add("depths", H5T_STD_U16LE, {kImages, kWidth, kHeight}, Numbers<uint16_t>("fcr"), "uint16");
  ExpectImages(folder / "x.mat");
}

TEST(Hdf5Files, OfMatlabHaveWhatIsInsideOfCells) {
  const TemporaryFolder folder;
  const auto images = MatlabImages();
  Hdf5Writer(folder / "x.mat")
      .Add("#refs#/c", H5T_STD_U16LE, {kWidth, kHeight}, images[0], "uint16")
      .Add("#refs#/b", H5T_STD_U16LE, {kWidth, kHeight}, images[1], "uint16")
      .Add("#refs#/aa", H5T_STD_U16LE, {kWidth, kHeight}, images[2], "uint16")
      .Refer("camera/depth", {"#refs#/c", "#refs#/b", "#refs#/aa"});
  ExpectImages(folder / "x.mat");
  ExpectImages((folder / "x.mat").string() + "#camera/depth");
}

TEST(Hdf5Files, ThatAreCutShortAreRefused) {
  const TemporaryFolder folder;
  Hdf5Writer(folder / "x.h5").Add("depth", H5T_STD_U16LE, kShape, Numbers<uint16_t>());
  std::filesystem::resize_file(folder / "x.h5", 2000);
  ExpectRefused([&] { OpenSource(folder / "x.h5"); }, "cut short or damaged");
  WriteBytes(folder / "x.h5", "x");
  ExpectRefused([&] { OpenSource(folder / "x.h5"); }, "expected an HDF5 file");
}

ArrayInfo InfoOf(const Shape& shape, bool is_column_major = false) {
  return {"x", {}, shape, is_column_major};
}

TEST(ArrayStacks, CountImagesByTheEndThatLeavesThemACamerasShape) {
  struct Case {
    Shape shape;
    bool is_matlab;
    size_t count;
    int width, height;
  };
  for (const Case& each : std::vector<Case>{{{300, 480, 640}, false, 300, 640, 480},
                                            {{480, 640, 300}, false, 300, 640, 480},
                                            {{424, 512, 100}, false, 100, 512, 424},
                                            {{100, 640, 480}, false, 100, 480, 640},  // on its side
                                            {{300, 480, 640}, true, 300, 480, 640},
                                            {{300, 640, 480}, true, 300, 640, 480},
                                            {{640, 480, 300}, true, 300, 640, 480},
                                            {{160, 120, 170}, false, 160, 170, 120},  // a crop
                                            {{480, 640}, false, 1, 640, 480},
                                            {{640, 480}, true, 1, 640, 480}}) {
    const auto stack = FindStack(InfoOf(each.shape, each.is_matlab));
    ASSERT_TRUE(stack);
    EXPECT_EQ(stack->count, each.count);
    EXPECT_EQ(stack->width, each.width);
    EXPECT_EQ(stack->height, each.height);
  }
  for (const Shape& shape : std::vector<Shape>{{}, {300}, {300, 2, 640}, {3, 300, 480, 640}}) {
    EXPECT_FALSE(FindStack(InfoOf(shape)));
  }
}

TEST(ArrayStacks, TakeAMatrixRowByRowOrColumnByColumn) {
  for (const std::vector<double>& matrix : std::vector<std::vector<double>>{
           {500, 0, 300, 0, 510, 200, 0, 0, 1}, {500, 0, 0, 0, 510, 0, 300, 200, 1}}) {
    const auto camera = CameraOfMatrix(matrix, 640, 480);
    ASSERT_TRUE(camera);
    EXPECT_EQ(camera->fy, 510);
    EXPECT_EQ(camera->cx, 300);
    EXPECT_EQ(camera->cy, 200);
  }
  EXPECT_FALSE(CameraOfMatrix({500, 0, 700, 0, 510, 200, 0, 0, 1}, 640, 480)) << "of larger images";
  EXPECT_FALSE(CameraOfMatrix({0, 0, 300, 0, 510, 200, 0, 0, 1}, 640, 480));
  EXPECT_FALSE(CameraOfMatrix({500, 0, 300, 0, 510, 200, 0, 0, 2}, 640, 480));
}

TEST(ArrayStacks, FindTimesThatAreSingleNumbersInTheirOrder) {
  std::vector<ArrayInfo> arrays;
  for (const char* name : {"f(10).t", "f(9).t", "f(11).t", "f(9).label", "f(10).label", "time"}) {
    arrays.push_back({name, {}, {}, true});
  }
  const auto times = FindTimes(arrays, 3);
  ASSERT_EQ(times.size(), 3u);
  EXPECT_EQ(times[0].name, "f(9).t");
  EXPECT_EQ(times[2].name, "f(11).t");
  EXPECT_TRUE(FindTimes(arrays, 2).empty());
}

TEST(ArrayStacks, FindTimesByTheirNameAndNumber) {
  const auto named = [](const std::string& name, const Shape& shape) {
    return ArrayInfo{name, {NumberKind::kFloat, 8, false}, shape, false};
  };
  const std::vector<ArrayInfo> arrays = {named("x", {5}), named("time_of_day", {4}),
                                         named("cam/Timestamps", {5}), named("t", {5})};
  ASSERT_EQ(FindTimes(arrays, 5).size(), 1u);
  EXPECT_EQ(FindTimes(arrays, 5)[0].name, "cam/Timestamps");
  EXPECT_TRUE(FindTimes(arrays, 6).empty());
}

}  // namespace
}  // namespace ossa::depth
