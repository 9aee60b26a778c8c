#include "depth/image/camera_io.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <future>

#include "depth/base/error.h"
#include "tests/support/refused.h"
#include "tests/support/temporary_folder.h"

namespace ossa::depth {
namespace {

using test::TemporaryFolder;

TEST(CameraJson, RoundTripIsExact) {
  const TemporaryFolder folder;
  const Camera camera{320, 240, 285.1234567890123, 286.5, 1.0 / 3.0, 119.75};
  WriteCameraJson(folder / "camera.json", camera);
  EXPECT_EQ(ReadCameraJson(folder / "camera.json"), camera);
}

// Reading a pipe without a writer would block, whatever signal arrives.
TEST(CameraJson, PipeIsRefused) {
  const TemporaryFolder folder;
  ASSERT_EQ(mkfifo((folder / "camera.json").c_str(), 0600), 0);
  auto read =
      std::async(std::launch::async, [&] { return ReadCameraJson(folder / "camera.json"); });
  const bool waits = read.wait_for(std::chrono::seconds(10)) == std::future_status::timeout;
  const int both_ends = open((folder / "camera.json").c_str(), O_RDWR);  // unblocks a reader
  EXPECT_FALSE(waits);
  EXPECT_THROW(read.get(), InputError);
  close(both_ends);
}

// An .npy file of version 1.
std::string Npy(const std::string& shape, bool is_fortran, const std::vector<double>& numbers) {
  std::string header = std::string("{'descr': '<f8', 'fortran_order': ") +
                       (is_fortran ? "True" : "False") + ", 'shape': " + shape + ", }";
  header.resize(117, ' ');
  header += '\n';
  return std::string("\x93NUMPY\1\0\x76\0", 10) + header +
         std::string(reinterpret_cast<const char*>(numbers.data()), 8 * numbers.size());
}

TEST(CameraFiles, MatrixOfNumpyIsRead) {
  const TemporaryFolder folder;
  const auto expect = [&](const std::string& bytes) {
    std::ofstream(folder / "K.npy", std::ios::binary) << bytes;
    const Camera camera = CameraForSize(ReadCameraFile(folder / "K.npy"), 640, 480);
    EXPECT_EQ(camera, (Camera{640, 480, 525.25, 526, 319.5, 239.5}));
  };
  expect(Npy("(3, 3)", false, {525.25, 0, 319.5, 0, 526, 239.5, 0, 0, 1}));
  expect(Npy("(3, 3)", true, {525.25, 0, 0, 0, 526, 0, 319.5, 239.5, 1}));
  expect(Npy("(3, 4)", false, {525.25, 0, 319.5, 0, 0, 526, 239.5, 0, 0, 0, 1, 0}));
}

TEST(CameraFiles, OtherArraysOfNumpyAreRefused) {
  const TemporaryFolder folder;
  const auto expect = [&](const char* name, const std::string& bytes, const char* named) {
    std::ofstream(folder / name, std::ios::binary) << bytes;
    test::ExpectRefused([&] { ReadCameraFile(folder / name); }, named);
  };
  expect("K.npy", Npy("(5,)", false, {1, 2, 3, 4, 5}), "expected a camera matrix, 3x3");
  expect("K.npy", Npy("(3, 3)", false, {1, 2, 3}), "expected a camera matrix, 3x3");
  expect("K.npy", "\x93NUMPY" + std::string(100, '\0'), "expected a NumPy array");
  expect("K.npz", "PK", "expected one matrix, found an archive of NumPy");
}

class BadCameraJson : public testing::TestWithParam<std::pair<const char*, const char*>> {};

TEST_P(BadCameraJson, IsRefusedWithTheFieldsName) {
  try {
    CameraFromJson(GetParam().first, "camera.json");
    FAIL() << "not noticed";
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).rfind("camera.json: ", 0), 0u) << error.what();
    EXPECT_NE(std::string(error.what()).find(GetParam().second), std::string::npos) << error.what();
  }
}

INSTANTIATE_TEST_SUITE_P(
    EachField, BadCameraJson,
    testing::Values(
        std::pair("", "not JSON"), std::pair(R"({"width":640e521})", "numbers"),
        std::pair("[1, 2]", "JSON object"), std::pair("{}", "\"width\""),
        std::pair(R"({"width":640,"height":0,"fx":1,"fy":1,"cx":0,"cy":0})", "\"height\""),
        std::pair(R"({"width":64.5,"height":48,"fx":1,"fy":1,"cx":0,"cy":0})", "whole number"),
        std::pair(R"({"width":64,"height":48,"fx":-1,"fy":1,"cx":0,"cy":0})", "\"fx\""),
        std::pair(R"({"width":64,"height":48,"fx":1,"fy":"1","cx":0,"cy":0})", "\"fy\""),
        std::pair(R"({"width":64,"height":48,"fx":1,"fy":1,"cx":1e9,"cy":0})", "\"cx\""),
        std::pair(R"({"width":64,"height":48,"fx":1,"fy":1,"cx":1})", "\"cy\"")));

TEST(CameraJson, DeepNestingIsRefusedBeforeParsing) {
  const std::string deep = "{\"width\":" + std::string(100'000, '[') + "1";
  test::ExpectRefused([&] { CameraFromJson(deep, "camera.json"); },
                      "camera.json: expected JSON that nests at most 32 deep");
}

TEST(ManifestCamera, IsTheCameraObject) {
  const TemporaryFolder folder;
  const Camera camera = KinectV1Camera(320, 240);
  std::ofstream(folder / "manifest.json") << R"({"camera":)" << CameraToJson(camera) << "}";
  EXPECT_EQ(ReadManifestCamera(folder / "manifest.json"), camera);
  std::ofstream(folder / "none.json") << "{}";
  EXPECT_THROW(ReadManifestCamera(folder / "none.json"), InputError);
}

TEST(CameraOption, PresetsScaleAndNumbersDoNot) {
  EXPECT_EQ(CameraForSize(ParseCamera("kinect-v1"), 320, 240), KinectV1Camera(320, 240));
  const Camera camera = CameraForSize(ParseCamera("525,526,319.5,239.5"), 320, 240);
  EXPECT_EQ(camera, (Camera{320, 240, 525, 526, 319.5, 239.5}));
}

TEST(CameraOption, OtherTextIsRefused) {
  for (const char* text :
       {"", "kinect", "1,2,3", "1,2,3,4,5", "1,2,3,", ",1,2,3,4", "0,1,2,3", "525,-1,2,3",
        "nan,1,2,3", "1,inf,2,3", "1e-300,1,2,3", "1,1e7,2,3", "1,1,1e300,3", "5 2,1,2,3"}) {
    EXPECT_THROW(ParseCamera(text), InputError) << text;
  }
}

}  // namespace
}  // namespace ossa::depth
