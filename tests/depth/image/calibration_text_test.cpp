#include "depth/image/calibration_text.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "depth/base/error.h"
#include "depth/image/camera_io.h"
#include "tests/support/refused.h"
#include "tests/support/temporary_folder.h"

namespace ossa::depth {
namespace {

// As ROS's camera_calibration saves it.
constexpr const char* kOst = R"(image_width: 640
image_height: 480
camera_name: narrow_stereo
camera_matrix:
  rows: 3
  cols: 3
  data: [ 580.5,    0. , 318.25,
            0. , 579. , 241.5,
            0. ,    0. ,   1. ]
distortion_model: plumb_bob
distortion_coefficients:
  rows: 1
  cols: 5
  data: [-0.25, 0.0625, 0.001, -0.002, 0.000000]
projection_matrix:
  rows: 3
  cols: 4
  data: [1, 0, 1, 0, 0, 1, 1, 0, 0, 0, 1, 0]
)";

// As cv::FileStorage does, whose keys are in no order that helps.
constexpr const char* kOpenCvYaml = R"(%YAML:1.0
---
calibration_time: "Sat"
image_width: 640
image_height: 480
cameraMatrix: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 5.8050000000000000e+02, 0., 3.1825000000000000e+02, 0.,
       579., 2.4150000000000000e+02, 0., 0., 1. ]
distCoeffs: !!opencv-matrix
   rows: 5
   cols: 1
   dt: d
   data: [ -2.5000000000000000e-01, 6.2500000000000000e-02, 1e-3, -2e-3, 0. ]
)";

constexpr const char* kXml = R"(<?xml version="1.0"?>
<opencv_storage>
<image_width>640</image_width>
<image_height>480</image_height>
<camera_matrix type_id="opencv-matrix">
  <rows>3</rows>
  <cols>3</cols>
  <dt>d</dt>
  <data>
    5.805e+02 0. 318.25 0. 579. 241.5 0. 0. 1.</data></camera_matrix>
<distortion_coefficients type_id="opencv-matrix">
  <rows>5</rows>
  <cols>1</cols>
  <dt>d</dt>
  <data>
    -0.25 0.0625 1e-3 -2e-3 0.</data></distortion_coefficients>
</opencv_storage>
)";

constexpr const char* kJson =
    R"({"image_width": 640, "image_height": 480, "D": [-0.25, 0.0625, 0.001, -0.002, 0],)"
    R"( "K": [[580.5, 0, 318.25], [0, 579, 241.5], [0, 0, 1]], "R": {"data": [1, 0]}})";

constexpr const char* kCameraInfo = R"(height: 480
width: 640
distortion_model: plumb_bob
d:
- -0.25
- 0.0625
- 0.001
- -0.002
- 0.0
k:
- 580.5
- 0.0
- 318.25
- 0.0
- 579.0
- 241.5
- 0.0
- 0.0
- 1.0
r:
- 1.0
)";

class StatedCalibration : public testing::TestWithParam<const char*> {};

TEST_P(StatedCalibration, IsRead) {
  const auto found = FindCalibration(GetParam(), "x");
  ASSERT_TRUE(found);
  EXPECT_EQ(found->width, 640);
  EXPECT_EQ(found->height, 480);
  EXPECT_EQ(found->matrix, (std::array<double, 9>{580.5, 0, 318.25, 0, 579, 241.5, 0, 0, 1}));
  EXPECT_EQ(found->distortion, (std::vector<double>{-0.25, 0.0625, 0.001, -0.002, 0}));
}

INSTANTIATE_TEST_SUITE_P(EachProgram, StatedCalibration,
                         testing::Values(kOst, kOpenCvYaml, kXml, kJson, kCameraInfo));

// As MATLAB has it, and Record3D's metadata.
TEST(Calibration, ColumnMajorMatrixIsRead) {
  const auto found =
      FindCalibration(R"({"w": 192, "K": [212.5, 0, 0, 0, 213, 0, 96, 128, 1]})", "x");
  ASSERT_TRUE(found);
  EXPECT_EQ(found->matrix, (std::array<double, 9>{212.5, 0, 96, 0, 213, 128, 0, 0, 1}));
}

TEST(Calibration, IntrinsicsMayBeAMatrixOfNineNumbers) {
  const std::string matrix = "<data>\n 525. 0. 319.5 0. 526. 239.5 0. 0. 1.</data>";
  const auto found =
      FindCalibration("<intrinsics type_id=\"opencv-matrix\">\n" + matrix + "</intrinsics>", "x");
  ASSERT_TRUE(found);
  EXPECT_EQ(found->matrix[5], 239.5);
  EXPECT_FALSE(FindCalibration(R"({"intrinsics": {"fx": 525}})", "x"));
}

TEST(Calibration, NumbersAloneAreAMatrix) {
  const std::array<double, 9> expected = {575.5, 0, 323, 0, 577, 236, 0, 0, 1};
  for (const char* text :
       {"575.5 0 323\n0 577 236\n0 0 1\n", "[575.5, 0, 323; 0, 577, 236; 0, 0, 1]",
        "5.755e+02 0 323 0\n0 577 236 0\n0 0 1 0\n0 0 0 1\n",
        "575.5 0 323 0\r\n0 577 236 0\r\n0 0 1 0\r\n"}) {
    const auto found = ReadBareMatrix(text);
    ASSERT_TRUE(found) << text;
    EXPECT_EQ(found->matrix, expected) << text;
  }
  for (const char* text : {"", "575.5 577 323 236", "fx 575.5", "1 2 3 4 5 6 7 8 9 10"}) {
    EXPECT_FALSE(ReadBareMatrix(text)) << text;
  }
}

// ScanNet has extrinsic_depth.txt beside intrinsic_depth.txt, and poses as 4 x 4 numbers.
TEST(Calibration, NumbersOfAPoseAreNoCameraMatrix) {
  for (const char* text :
       {"1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n", "1 2 3\n4 5 6\n7 8 9\n", "1 0 0 0 1 0 0 0 1",
        "-0.96 0.27 -0.08 2.65\n0.27 0.76 -0.59 2.98\n-0.1 -0.59 -0.8 1.37\n0 0 0 1\n"}) {
    EXPECT_FALSE(ReadBareMatrix(text)) << text;
  }
}

TEST(Calibration, OtherTextHasNone) {
  for (const char* text : {"", "{}", "camera: K", "%YAML:1.0", R"({"width": 64, "fx": 1})"}) {
    EXPECT_FALSE(FindCalibration(text, "x")) << text;
  }
}

TEST(Calibration, TooFewNumbersAreRefused) {
  test::ExpectRefused([] { FindCalibration("K: [1, 2, x, 3]", "a.yaml"); },
                      "a.yaml: expected nine numbers of a camera matrix, found 2");
  EXPECT_THROW(FindCalibration("width: many\nK: [1,0,0,0,1,0,0,0,1]", "a.yaml"), InputError);
}

// Along the diagonal from the centre k1 moves a corner by f k1 r^3: of f 100 and r 0.5 by 12.5 k1.
TEST(CornerShift, IsTheDistortionAtTheCorner) {
  Calibration calibration{.width = 61, .height = 81, .matrix = {100, 0, 30, 0, 100, 40, 0, 0, 1}};
  EXPECT_EQ(ComputeCornerShift(calibration), 0.0);
  calibration.distortion = {0.2, 0, 0, 0, 0};
  EXPECT_NEAR(ComputeCornerShift(calibration), 2.5, 1e-12);
  calibration.width = calibration.height = 0;  // twice the centre then
  EXPECT_NEAR(ComputeCornerShift(calibration), 2.5, 1e-12);
  calibration.model = "equidistant";
  EXPECT_TRUE(std::isnan(ComputeCornerShift(calibration)));
  calibration.distortion = {0, 0, 0, 0};
  EXPECT_TRUE(std::isnan(ComputeCornerShift(calibration)));
}

class CameraFile : public testing::Test {
 protected:
  std::string Write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  test::TemporaryFolder folder_;
};

TEST_F(CameraFile, GivesTheCameraOfTheOption) {
  const CameraChoice choice = ParseCamera(Write("ost.yaml", kOst));
  EXPECT_EQ(choice.camera, (Camera{640, 480, 580.5, 579, 318.25, 241.5}));
  EXPECT_NE(choice.unheeded.find("ost.yaml: the lens moves the image's corners by "),
            std::string::npos)
      << choice.unheeded;
  WriteCameraJson(folder_ / "camera.json", KinectV1Camera(320, 240));
  const CameraChoice plain = ParseCamera(folder_ / "camera.json");
  EXPECT_EQ(CameraForSize(plain, 640, 480), Resized(KinectV1Camera(320, 240), 640, 480));
  EXPECT_EQ(plain.unheeded, "");
}

TEST_F(CameraFile, WithoutASizeFitsAnyImages) {
  const CameraChoice choice = ParseCamera(Write("k.yml", "K: [100, 0, 30, 0, 110, 40, 0, 0, 1]\n"));
  EXPECT_EQ(CameraForSize(choice, 64, 48), (Camera{64, 48, 100, 110, 30, 40}));
}

TEST_F(CameraFile, MayBeAMatrixOfNumbersOnly) {
  const CameraChoice choice = ParseCamera(Write("k.txt", "100 0 30\n0 110 40\n0 0 1\n"));
  EXPECT_EQ(CameraForSize(choice, 64, 48), (Camera{64, 48, 100, 110, 30, 40}));
  test::ExpectRefused([&] { ParseCamera(Write("a.txt", "100 110\n")); },
                      "a.txt: expected a camera_m");
  const CameraChoice marked = ParseCamera(Write("b.txt",
                                                "\xEF\xBB\xBF"
                                                "100 0 30\n0 110 40\n0 0 1\n"));
  EXPECT_EQ(marked.camera.fx, 100);
}

TEST_F(CameraFile, MayNameTheFourNumbers) {
  for (const char* text :
       {"%YAML:1.0\nCamera.fx: 100.0\nCamera.fy: 110.0\nCamera.cx: 30.0\nCamera.cy: 40.0\n"
        "Camera.k1: 0.0\nDepthMapFactor: 5000.0\n",
        "fx = 100\r\nfy = 110\r\ncx = 30\r\ncy = 40\r\n",
        "\xEF\xBB\xBF"
        "fx 100\nfy 110\ncx 30\ncy 40",
        "name = my camera 2\nFX: 100\nFY: 110\nCX: 30\nCY: 40\nfx: 7\n"}) {
    const CameraChoice choice = ParseCamera(Write("k.yaml", text));
    EXPECT_EQ(CameraForSize(choice, 64, 48), (Camera{64, 48, 100, 110, 30, 40})) << text;
    EXPECT_EQ(choice.unheeded, "") << text;
  }
  test::ExpectRefused([&] { ParseCamera(Write("k.yaml", "fx: 100\nfy: 110\ncx: 30\n")); },
                      "fx, fy, cx and cy by name");
  const CameraChoice bent =
      ParseCamera(Write("k.yaml",
                        "Camera.fx: 100\nCamera.fy: 110\nCamera.cx: 30\nCamera.cy: 40\n"
                        "Camera.k1: 0.3\nCamera.width: 64\nCamera.height: 48\n"));
  EXPECT_EQ(bent.camera, (Camera{64, 48, 100, 110, 30, 40}));
  EXPECT_NE(bent.unheeded.find("the lens moves"), std::string::npos) << bent.unheeded;
}

TEST_F(CameraFile, OfKalibrHasItsPinholeCamera) {
  const std::string camera =
      "  cam_overlaps: []\n  camera_model: pinhole\n  distortion_coeffs: [0.001, 0, 0, 0]\n"
      "  distortion_model: radtan\n  intrinsics: [100, 110, 30, 40]\n  resolution: [64, 48]\n"
      "  rostopic: /depth\n";
  const CameraChoice choice = ParseCamera(Write("camchain.yaml", "cam0:\n" + camera));
  EXPECT_EQ(choice.camera, (Camera{64, 48, 100, 110, 30, 40}));
  EXPECT_EQ(choice.unheeded, "");
  test::ExpectRefused(
      [&] { ParseCamera(Write("two.yaml", "cam0:\n" + camera + "cam1:\n" + camera)); },
      "two.yaml: expected one camera, found several");
  test::ExpectRefused(
      [&] { ParseCamera(Write("o.yaml", "a:\n  camera_model: omni\n  intrinsics: [1, 2]\n")); },
      "o.yaml: expected camera_model pinhole and four intrinsics, found omni and 2");
}

TEST_F(CameraFile, OfEurocHasItsLens) {
  const CameraChoice choice = ParseCamera(
      Write("sensor.yaml",
            "resolution: [64, 48]\ncamera_model: pinhole\nintrinsics: [100, 110, 30, 40] #fu, fv\n"
            "distortion_model: radial-tangential\ndistortion_coefficients: [0.3, 0, 0, 0]\n"));
  EXPECT_EQ(choice.camera, (Camera{64, 48, 100, 110, 30, 40}));
  EXPECT_NE(choice.unheeded.find("the lens moves"), std::string::npos) << choice.unheeded;
}

// COLMAP counts pixels from their corners.
TEST_F(CameraFile, OfColmapIsMovedByHalfAPixel) {
  const std::string head = "# Camera list\n#   CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]\n";
  const auto read = [&](const std::string& line) {
    return ParseCamera(Write("cameras.txt", head + line + "\n"));
  };
  EXPECT_EQ(read("1 PINHOLE 64 48 100 110 30.5 40.5").camera, (Camera{64, 48, 100, 110, 30, 40}));
  EXPECT_EQ(read("7 SIMPLE_RADIAL 64 48 100 30.5 40.5 0").camera,
            (Camera{64, 48, 100, 100, 30, 40}));
  EXPECT_NE(read("1 OPENCV_FISHEYE 64 48 100 110 30 40 0.1 0 0 0").unheeded.find("OPENCV_FISHEYE"),
            std::string::npos);
  test::ExpectRefused([&] { read("1 PINHOLE 64 48 100 110 30.5"); },
                      "cameras.txt: line 3: expected CAMERA_ID PINHOLE WIDTH HEIGHT and 4 param");
  test::ExpectRefused([&] { read("1 PINHOLE 64 48 9 9 3 4\n2 PINHOLE 64 48 9 9 3 4"); },
                      "cameras.txt: line 4: expected one camera, found another");
}

TEST_F(CameraFile, MayHaveAnyExtensionAndFurtherNumbers) {
  const CameraChoice choice =
      ParseCamera(Write("depth.cal", "100 0 30\n0 110 40\n0 0 1\n\n0 0 0 0\n\n64 48\n"));
  EXPECT_EQ(CameraForSize(choice, 64, 48), (Camera{64, 48, 100, 110, 30, 40}));
  test::ExpectRefused([&] { ParseCamera((folder_ / "none.cal").string()); }, "--camera: expected");
}

TEST_F(CameraFile, AcceptsRealSenseNamesOfTheCentre) {
  const CameraChoice choice = ParseCamera(Write(
      "rs.json", R"({"width": 64, "height": 48, "fx": 100, "fy": 110, "ppx": 30, "ppy": 40})"));
  EXPECT_EQ(choice.camera, (Camera{64, 48, 100, 110, 30, 40}));
}

TEST_F(CameraFile, FileWithoutACameraIsRefused) {
  test::ExpectRefused([&] { ParseCamera(Write("a.yaml", "fps: 30\n")); },
                      "a.yaml: expected a camera_matrix");
  test::ExpectRefused([&] { ParseCamera(Write("b.yaml", "K: [0,0,0,0,0,0,0,0,0]")); },
                      "b.yaml: camera");
  test::ExpectRefused([&] { ParseCamera((folder_ / "none.xml").string()); }, "none.xml");
}

}  // namespace
}  // namespace ossa::depth
