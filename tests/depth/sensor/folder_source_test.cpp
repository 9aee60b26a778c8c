#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include "depth/base/error.h"
#include "depth/image/camera_io.h"
#include "depth/image/depth_png.h"
#include "depth/sensor/frame_source.h"
#include "tests/support/places.h"
#include "tests/support/refused.h"
#include "tests/support/temporary_folder.h"

namespace ossa::depth {
namespace {

using std::chrono::milliseconds;
using test::TemporaryFolder;

void WriteFrame(const std::filesystem::path& path, uint16_t value, int width = 8, int height = 6) {
  const Image<uint16_t> image(width, height, value);
  WriteDepthPng(path, {image.data.data(), width, height, width});
}

ReadResult Next(FrameSource& source) { return source.Read(milliseconds(10)); }

TEST(FolderSource, GivesFramesInNameOrderAt30HzAndThenTheEnd) {
  const TemporaryFolder folder;
  for (const char* name : {"b.png", "a.png", "c.png"}) {
    WriteFrame(folder / name, static_cast<uint16_t>(name[0]));
  }
  const auto source = OpenSource(folder.path().string());
  EXPECT_EQ(source->frame_count(), 3);
  EXPECT_FALSE(source->is_live());
  for (int i = 0; i < 3; ++i) {
    const ReadResult result = Next(*source);
    ASSERT_EQ(result.status, ReadStatus::kFrame);
    EXPECT_EQ(result.frame.depth_mm[0], 'a' + i);
    EXPECT_EQ(result.frame.index, i);
    EXPECT_DOUBLE_EQ(result.frame.time_s, i / 30.0);
    EXPECT_EQ(result.dropped, 0);
  }
  EXPECT_EQ(Next(*source).status, ReadStatus::kEnd);
  EXPECT_EQ(Next(*source).status, ReadStatus::kEnd);
}

TEST(FolderSource, AMissingNumberIsADroppedFrameAndTimePasses) {
  const TemporaryFolder folder;
  for (const char* name : {"000003.png", "000004.png", "000007.png"}) WriteFrame(folder / name, 1);
  const auto source = OpenSource(folder.path().string());
  EXPECT_EQ(Next(*source).frame.index, 3);
  EXPECT_EQ(Next(*source).dropped, 0);
  const ReadResult third = Next(*source);
  EXPECT_EQ(third.dropped, 2);
  EXPECT_EQ(third.frame.index, 7);
  EXPECT_DOUBLE_EQ(third.frame.time_s, 4 / 30.0);
}

TEST(FolderSource, NumbersThatAreTimeStampsAreNotCounted) {
  const TemporaryFolder folder;
  for (const char* name : {"d-1028.png", "d-1038.png"}) WriteFrame(folder / name, 1);
  const auto source = OpenSource(folder.path().string());
  Next(*source);
  EXPECT_EQ(Next(*source).dropped, 0);
}

// What a source told, a line a note.
struct Notes {
  std::string text;
  SourceOptions Options() {
    SourceOptions options;
    options.note = [this](NoteKind, const std::string& note) { text += note + "\n"; };
    return options;
  }
  bool Tell(const std::string& part) const { return text.find(part) != std::string::npos; }
};

// The values of all frames to the end.
std::vector<uint16_t> ValuesOf(FrameSource& source) {
  std::vector<uint16_t> values;
  for (ReadResult result; (result = Next(source)).status == ReadStatus::kFrame;) {
    values.push_back(result.frame.depth_mm[0]);
  }
  return values;
}

std::vector<double> TimesOf(FrameSource& source) {
  std::vector<double> times_s;
  for (ReadResult result; (result = Next(source)).status == ReadStatus::kFrame;) {
    times_s.push_back(result.frame.time_s);
  }
  return times_s;
}

TEST(FolderSource, TheLargestNumberIsNoReading) {
  const TemporaryFolder folder;
  for (const auto& [name, value] : {std::pair("0.png", 65535), {"1.png", 65534}, {"2.png", 9}}) {
    WriteFrame(folder / name, static_cast<uint16_t>(value));
  }
  const auto source = OpenSource(folder.path().string());
  EXPECT_EQ(ValuesOf(*source), (std::vector<uint16_t>{0, 65534, 9}));
}

TEST(FolderSource, FramesComeInNaturalOrder) {
  const TemporaryFolder folder;
  for (const int number : {1, 2, 10, 9, 100}) {
    WriteFrame(folder / ("img_" + std::to_string(number) + ".png"), static_cast<uint16_t>(number));
  }
  const auto source = OpenSource(folder.path().string());
  EXPECT_EQ(ValuesOf(*source), (std::vector<uint16_t>{1, 2, 9, 10, 100}));
}

TEST(FolderSource, TimesInNamesAreTimes) {
  const TemporaryFolder folder;
  for (const char* name :
       {"1305031102.175304.png", "1305031102.275304.png", "1305031104.275304.png"})
    WriteFrame(folder / name, 1);
  const auto times_s = TimesOf(*OpenSource(folder.path().string()));
  ASSERT_EQ(times_s.size(), 3u);
  EXPECT_NEAR(times_s[1], 0.1, 1e-6);
  EXPECT_NEAR(times_s[2], 2.1, 1e-6);
}

// Or are every thirtieth frame: whoever reads them must know what was made of it.
TEST(FolderSource, NumbersThatAreTakenForTimesAreToldOf) {
  const TemporaryFolder folder;
  for (const char* name : {"0.png", "30.png", "60.png"}) WriteFrame(folder / name, 1);
  Notes notes;
  EXPECT_NEAR(TimesOf(*OpenSource(folder.path().string(), notes.Options()))[2], 0.06, 1e-9);
  EXPECT_TRUE(notes.Tell("numbers in its names")) << notes.text;
  EXPECT_TRUE(notes.Tell("taken for milliseconds: --fps says otherwise")) << notes.text;
}

// As many a program prints a number.
TEST(FolderSource, TimesWithoutTheirLastZerosAreInOrder) {
  const TemporaryFolder folder;
  for (const char* name : {"7.0.png", "7.033.png", "7.067.png", "7.1.png"}) {
    WriteFrame(folder / name, 1);
  }
  const auto source = OpenSource(folder.path().string());
  for (int i = 0; i < 4; ++i) {
    const ReadResult next = Next(*source);
    EXPECT_NEAR(next.frame.time_s, i / 30.0, 1e-3);
    EXPECT_EQ(next.frame.index, i);
    EXPECT_EQ(next.dropped, 0);
  }
}

TEST(FolderSource, DepthTxtSaysWhatIsWhen) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "depth");
  for (const char* name : {"b.png", "a.png", "c.png"}) {
    WriteFrame(folder / (std::string("depth/") + name), static_cast<uint16_t>(name[0]));
  }
  std::ofstream(folder / "depth.txt") << "# time file\n5.0 depth/b.png\n5.1 depth/a.png\n";
  for (const std::string& source : {folder.path().string(), (folder / "depth").string()}) {
    EXPECT_TRUE(IsRecording(source));
    EXPECT_EQ(ValuesOf(*OpenSource(source)), (std::vector<uint16_t>{'b', 'a'})) << source;
    EXPECT_NEAR(TimesOf(*OpenSource(source))[1], 0.1, 1e-9);
  }
}

// As a program dumps a matrix.
TEST(FolderSource, AnotherProgramsDepthTxtIsPassedOverWithANote) {
  const TemporaryFolder folder;
  std::ofstream(folder / "depth.txt") << "# rows\n1203 1204 1207\n1203 1204 1208\n";
  test::ExpectRefused([&] { OpenSource(folder.path().string()); },
                      "depth.txt: expected seconds and files that are there, found line 2: '1204'");
  for (const char* name : {"0.png", "1.png"}) WriteFrame(folder / name, 7);
  Notes notes;
  EXPECT_EQ(ValuesOf(*OpenSource(folder.path().string(), notes.Options())).size(), 2u);
  EXPECT_TRUE(notes.Tell("found line 2: '1204' and the like: passed over")) << notes.text;
}

TEST(FolderSource, FramesOfAListAreNotPassedOverHoweverTheFolderIsWritten) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "depth");
  WriteFrame(folder / "depth/a.png", 1);
  std::ofstream(folder / "depth.txt") << "5.0 depth/a.png\n";
  Notes notes;
  OpenSource((folder / "depth/../depth").string(), notes.Options());
  EXPECT_FALSE(notes.Tell("passed over")) << notes.text;
}

TEST(FolderSource, FpsIsTheRateWhateverTheNamesSay) {
  const TemporaryFolder folder;
  for (const char* name : {"0.000.png", "0.033.png"}) WriteFrame(folder / name, 1);
  EXPECT_DOUBLE_EQ(TimesOf(*OpenSource(folder.path().string(), {.fps = 10.0}))[1], 0.1);
}

TEST(FolderSource, AnUnreadableFrameIsSkippedCountedAndToldOf) {
  const TemporaryFolder folder;
  std::ofstream(folder / "0.png") << "not a PNG";
  WriteFrame(folder / "1.png", 2);
  std::ofstream(folder / "2.png") << "";
  WriteFrame(folder / "3.png", 4);
  std::ofstream(folder / "4.png") << "cut";
  Notes notes;
  const auto source = OpenSource(folder.path().string(), notes.Options());
  const ReadResult first = Next(*source), second = Next(*source);
  EXPECT_EQ(first.frame.depth_mm[0], 2);
  EXPECT_EQ(first.dropped, 1);
  EXPECT_EQ(second.frame.depth_mm[0], 4);
  EXPECT_EQ(second.dropped, 1);
  const ReadResult end = Next(*source);
  EXPECT_EQ(end.status, ReadStatus::kEnd);
  EXPECT_EQ(end.dropped, 1);
  EXPECT_EQ(Next(*source).dropped, 0) << "told once";
  EXPECT_TRUE(notes.Tell("skipped 3 of 5 frames")) << notes.text;
  EXPECT_TRUE(notes.Tell("0.png: byte 0")) << notes.text;
}

TEST(FolderSource, WhereNoFrameCanBeReadTheFirstIsRefused) {
  const TemporaryFolder folder;
  std::ofstream(folder / "0.png") << "not a PNG";
  EXPECT_THROW(OpenSource(folder.path().string()), InputError);
}

TEST(FolderSource, AFrameOfAnotherSizeIsSkippedEvenTheFirst) {
  const TemporaryFolder folder;
  WriteFrame(folder / "0.png", 1, 16, 12);
  for (const char* name : {"1.png", "2.png"}) WriteFrame(folder / name, 1);
  Notes notes;
  const auto source = OpenSource(folder.path().string(), notes.Options());
  EXPECT_EQ(source->camera().width, 8);
  EXPECT_EQ(ValuesOf(*source).size(), 2u);
  EXPECT_TRUE(notes.Tell("0.png: expected 8x6 like the other frames, found 16x12")) << notes.text;
}

TEST(FolderSource, WhatIsNoDepthImageIsPassedOverWithANote) {
  const TemporaryFolder folder;
  for (const char* name : {"depth_0.png", "depth_1.png", "ir_0.png"}) WriteFrame(folder / name, 1);
  std::ofstream(folder / "._depth_0.png") << "Mac";
  std::ofstream(folder / "notes.txt") << "text";
  const Image<uint8_t> grey(8, 6, 0);
  WriteLabelPng(folder / "depth_shown.png", grey);
  Notes notes;
  const auto source = OpenSource(folder.path().string(), notes.Options());
  EXPECT_EQ(source->frame_count(), 2);
  EXPECT_TRUE(notes.Tell("passed over 4 files")) << notes.text;
}

TEST(FolderSource, TwoSequencesInOneFolderAreToldOf) {
  const TemporaryFolder folder;
  for (const char* name : {"depth_0.png", "depth_1.png", "depth_raw_0.png"}) {
    WriteFrame(folder / name, 1);
  }
  Notes notes;
  OpenSource(folder.path().string(), notes.Options());
  EXPECT_FALSE(notes.Tell("kinds")) << notes.text;
  WriteFrame(folder / "depth_raw_1.png", 1);
  OpenSource(folder.path().string(), notes.Options());
  EXPECT_TRUE(notes.Tell("depth images of 2 kinds by their names ('depth_', 'depth_raw_')"))
      << notes.text;
}

TEST(FolderSource, ImagesThatAreNoneOfDepthAreRefusedByTheirKind) {
  const TemporaryFolder folder;
  WriteLabelPng(folder / "0.png", Image<uint8_t>(8, 6, 0));
  test::ExpectRefused([&] { OpenSource(folder.path().string()); },
                      "expected one channel of 16 bits, found grey of 8 bits");
}

TEST(FolderSource, CameraIsTheOptionElseCameraJsonElseBySize) {
  const TemporaryFolder folder;
  WriteFrame(folder / "0.png", 1);
  EXPECT_EQ(OpenSource(folder.path().string())->camera(), KinectV1Camera(8, 6));
  const SourceOptions options{.camera = ParseCamera("5,6,4,3"), .device_wait = {}};
  const Camera chosen{8, 6, 5, 6, 4, 3}, stated{8, 6, 7, 7, 4, 3};
  EXPECT_EQ(OpenSource(folder.path().string(), options)->camera(), chosen);
  WriteCameraJson(folder / "camera.json", stated);
  EXPECT_EQ(OpenSource(folder.path().string())->camera(), stated);
  EXPECT_EQ(OpenSource(folder.path().string(), options)->camera(), chosen);
  WriteCameraJson(folder / "camera.json", KinectV1Camera(640, 480));
  EXPECT_THROW(OpenSource(folder.path().string()), InputError);
}

TEST(FolderSource, MirroredImagesComeAsTheSensorLooksWithTheCameraOfTheseImages) {
  const TemporaryFolder folder;
  Image<uint16_t> image(8, 6, 1000);
  image.at(1, 2) = 2000;
  WriteDepthPng(folder / "0.png", {image.data.data(), 8, 6, 8});
  WriteCameraJson(folder / "camera.json", {8, 6, 7, 7, 2.5, 3});
  const Camera unmirrored{8, 6, 7, 7, 4.5, 3}, chosen{8, 6, 5, 6, 3, 3};
  const auto source = OpenSource(folder.path().string(), {.mirrored = true});
  EXPECT_EQ(source->camera(), unmirrored);
  const DepthFrame frame = Next(*source).frame;
  EXPECT_EQ(frame.camera, unmirrored);
  EXPECT_EQ(frame.view().at(6, 2), 2000);
  EXPECT_EQ(frame.view().at(1, 2), 1000);
  EXPECT_EQ(source->frame_count(), 1);
  EXPECT_EQ(Next(*source).status, ReadStatus::kEnd);
  const SourceOptions options{.camera = ParseCamera("5,6,4,3"), .mirrored = true};
  EXPECT_EQ(OpenSource(folder.path().string(), options)->camera(), chosen);
}

// A preset, given or taken by the size, is of no image: it is the sensor's.
TEST(FolderSource, PresetsAreTheSameForMirroredImages) {
  const TemporaryFolder folder;
  WriteFrame(folder / "0.png", 1);
  EXPECT_EQ(OpenSource(folder.path().string(), {.mirrored = true})->camera(), KinectV1Camera(8, 6));
  const SourceOptions options{.camera = ParseCamera("kinect-v2"), .mirrored = true};
  EXPECT_EQ(OpenSource(folder.path().string(), options)->camera(), PresetCamera("kinect-v2", 8, 6));
}

TEST(FolderSource, ACameraTakenByTheImageSizeIsToldOf) {
  const TemporaryFolder folder;
  WriteFrame(folder / "0.png", 1, 512, 424);
  Notes notes;
  const auto source = OpenSource(folder.path().string(), notes.Options());
  EXPECT_EQ(source->camera().fx, 366.0);
  EXPECT_TRUE(notes.Tell("512x424 are taken for a kinect-v2's (f 366 px)")) << notes.text;
}

TEST(FolderSource, TheFolderOfDepthBelowIsNamedWhereTheOneAboveIsGiven) {
  const TemporaryFolder folder;
  const std::string name = folder.path().string();
  test::ExpectRefused([&] { OpenSource(name); }, "found none in it");
  for (const char* below : {"aligned", "depth"}) std::filesystem::create_directory(folder / below);
  WriteFrame(folder / "aligned/0.png", 1);
  WriteFrame(folder / "depth/0.png", 1);
  test::ExpectRefused([&] { OpenSource(name); }, "found none in it, but in " + name + "/depth");
}

// As Open3D's recorders lay their folders out.
TEST(FolderSource, TheCameraThatOpen3dWroteAboveItIsTaken) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "depth");
  WriteFrame(folder / "depth/000000.png", 1, 640, 480);
  std::ofstream(folder / "camera_intrinsic.json")
      << R"({"width": 640, "height": 480, "intrinsic_matrix": [612.5, 0, 0, 0, 611, 0, 322, 237, 1]})";
  Notes notes;
  const auto source = OpenSource((folder / "depth/").string(), notes.Options());
  EXPECT_EQ(source->camera(), (Camera{640, 480, 612.5, 611.0, 322.0, 237.0}));
  EXPECT_TRUE(notes.Tell("camera_intrinsic.json: the camera is as it says")) << notes.text;
  std::ofstream(folder / "camera_intrinsic.json") << R"({"focal": 612.5})";
  Notes others;
  EXPECT_EQ(OpenSource((folder / "depth").string(), others.Options())->camera().fx, 575.0);
  EXPECT_TRUE(others.Tell("camera_intrinsic.json: passed over: ")) << others.text;
}

// As data sets of scenes lay their folders out.
TEST(FolderSource, AMatrixOfNumbersAloneIsTakenIfItsCentreIsTheImages) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "depth");
  std::filesystem::create_directories(folder / "intrinsic");
  WriteFrame(folder / "depth/0.png", 1, 640, 480);
  std::ofstream(folder / "intrinsics.txt") << "1165 0 649 0\n0 1166 484 0\n0 0 1 0\n0 0 0 1\n";
  Notes colour;
  EXPECT_EQ(OpenSource((folder / "depth").string(), colour.Options())->camera().fx, 575.0);
  EXPECT_TRUE(colour.Tell("its centre is not that of images of 640x480")) << colour.text;
  std::ofstream(folder / "intrinsic/intrinsic_depth.txt")
      << "577.5 0 319 0\n0 578 240 0\n0 0 1 0\n0 0 0 1\n";
  const auto source = OpenSource((folder / "depth").string());
  EXPECT_EQ(source->camera(), (Camera{640, 480, 577.5, 578.0, 319.0, 240.0}));
}

TEST(FolderSource, TheCalibrationThatRosSavedBesideItIsTakenAndItsLensToldOf) {
  const TemporaryFolder folder;
  WriteFrame(folder / "0.png", 1, 640, 480);
  std::ofstream(folder / "ost.yaml")
      << "image_width: 640\nimage_height: 480\n"
         "camera_matrix:\n  rows: 3\n  data: [600, 0, 320, 0, 601, 240, 0, 0, 1]\n"
         "distortion_coefficients:\n  data: [-0.3, 0.1, 0, 0, 0]\n";
  Notes notes;
  const auto source = OpenSource(folder.path().string(), notes.Options());
  EXPECT_EQ(source->camera(), (Camera{640, 480, 600, 601, 320, 240}));
  EXPECT_TRUE(notes.Tell("ost.yaml: the camera is as it says")) << notes.text;
  EXPECT_TRUE(notes.Tell("ost.yaml: the lens moves the image's corners by ")) << notes.text;
}

TEST(FolderSource, ACameraOfImagesOfAnotherShapeIsWarnedOf) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "in");
  WriteFrame(folder / "in/0.png", 1, 320, 240);
  WriteCameraJson(folder / "wide.json", {1280, 720, 920, 920, 640, 360});
  WriteCameraJson(folder / "same.json", {641, 481, 580, 580, 320, 240});
  Notes notes;
  SourceOptions options = notes.Options();
  options.camera = ParseCamera(folder / "same.json");
  OpenSource((folder / "in").string(), options);
  EXPECT_FALSE(notes.Tell("of another shape")) << notes.text;
  options.camera = ParseCamera(folder / "wide.json");
  OpenSource((folder / "in").string(), options);
  EXPECT_TRUE(notes.Tell("stated for images of 1280x720, these are of another shape, 320x240"))
      << notes.text;
}

TEST(FolderSource, NamesInCapitalsAreFramesToo) {
  const TemporaryFolder folder;
  EXPECT_FALSE(IsRecording(folder.path()));
  WriteFrame(folder / "000007.PNG", 70);
  EXPECT_TRUE(IsRecording(folder.path()));
  WriteFrame(folder / "000009.png", 90);
  const auto source = OpenSource(folder.path().string());
  EXPECT_EQ(source->frame_count(), 2);
  EXPECT_EQ(Next(*source).frame.index, 7);
  EXPECT_EQ(Next(*source).dropped, 1);
  WriteFrame(folder / "000007.png", 71);  // beside the one in capitals: names count no frames
  const auto counted = OpenSource(folder.path().string());
  for (int i = 0; i < 3; ++i) {
    const ReadResult next = Next(*counted);
    EXPECT_EQ(next.frame.index, i);
    EXPECT_EQ(next.dropped, 0);
  }
}

TEST(OpenSource, OnePngIsAFrame) {
  const TemporaryFolder folder;
  WriteFrame(folder / "000007.png", 70);
  WriteFrame(folder / "000008.PNG", 80);
  for (const char* name : {"000007.png", "000008.PNG"}) {
    EXPECT_TRUE(IsRecording(folder / name));
    const auto source = OpenSource((folder / name).string());
    EXPECT_EQ(source->frame_count(), 1);
    const ReadResult only = Next(*source);
    ASSERT_EQ(only.status, ReadStatus::kFrame);
    EXPECT_EQ(only.frame.depth_mm[0], name[5] == '7' ? 70 : 80);
    EXPECT_EQ(only.frame.index, 0);
    EXPECT_EQ(Next(*source).status, ReadStatus::kEnd);
  }
  Camera camera = KinectV1Camera(8, 6);
  camera.fx = 5.0;
  WriteCameraJson(folder / "camera.json", camera);
  EXPECT_EQ(OpenSource((folder / "000007.png").string())->camera().fx, 5.0);
  std::ofstream(folder / "cut.png") << "\x89PNG";
  EXPECT_THROW(OpenSource((folder / "cut.png").string()), InputError);
  EXPECT_THROW(OpenSource((folder / "none.png").string()), InputError);
}

// A data set of one image, whose manifest says the camera.
class DataSetSource : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directory(folder_ / "depth");
    WriteFrame(folder_ / "depth/000000.png", 42);
    std::ofstream(folder_ / "manifest.json") << R"({"camera":)" << CameraToJson(kCamera) << "}";
  }
  Camera CameraOf(const char* name) const {
    return OpenSource((folder_ / name).string())->camera();
  }

  static constexpr Camera kCamera{8, 6, 9, 9, 4, 3};
  const TemporaryFolder folder_;
};

TEST_F(DataSetSource, TakesTheManifestsCameraAndTheDepthFolder) {
  const auto source = OpenSource(folder_.path().string());
  EXPECT_EQ(source->camera(), kCamera);
  EXPECT_EQ(Next(*source).frame.depth_mm[0], 42);
  EXPECT_EQ(CameraOf("depth/000000.png"), kCamera);
}

TEST_F(DataSetSource, AStillHasItsCameraHoweverItsPathIsWritten) {
  for (const char* name : {"depth/./000000.png", "depth/../depth/000000.png"}) {
    EXPECT_EQ(CameraOf(name), kCamera) << name;
  }
}

TEST(SourceOptions, NumbersThatCannotBeAreRefused) {
  const TemporaryFolder folder;
  WriteFrame(folder / "0.png", 1);
  const std::string name = folder.path().string();
  for (const double bad : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    test::ExpectRefused([&] { OpenSource(name, {.depth_scale = bad}); }, "depth_scale");
    test::ExpectRefused([&] { OpenSource(name, {.fps = bad}); }, "fps");
  }
  test::ExpectRefused([&] { OpenSource(name, {.inverted_from = 0}); }, "inverted_from");
}

TEST(OpenSource, ARecordingThatIsNoFileSaysWhatItIs) {
  const TemporaryFolder folder;
  for (const char* name : {"pipe.oni", "pipe.mkv", "pipe.bag"}) {
    mkfifo((folder / name).c_str(), 0600);
    test::ExpectRefused([&] { OpenSource((folder / name).string()); }, "such as a pipe");
  }
  test::ExpectRefused([&] { OpenSource((folder / "none.oni").string()); }, "no such file");
}

TEST(OpenSource, AFileOfAnotherKindIsNotSaidToBeMissing) {
  const TemporaryFolder folder;
  std::ofstream(folder / "depth.xyz") << "II*";
  test::ExpectRefused([&] { OpenSource((folder / "depth.xyz").string()); },
                      "found what has none of these names");
  test::ExpectRefused([&] { OpenSource((folder / "none.xyz").string()); }, "no such thing");
}

TEST(OpenSource, WhatIsNotASourceIsOneLine) {
  const TemporaryFolder folder;
  for (const std::string& name : {std::string("/nowhere"), folder.path().string(), std::string()}) {
    try {
      OpenSource(name);
      FAIL() << name;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("expected"), std::string::npos) << error.what();
    }
  }
}

TEST(RealFrames, SkeltrackIsEightFramesOf640x480) {
  const std::string folder = test::SharedFolder() / "real/depth_frames/skeltrack_v1";
  if (!std::filesystem::is_directory(folder)) GTEST_SKIP() << "not here: " << folder;
  const auto source = OpenSource(folder);
  int count = 0;
  for (ReadResult result; (result = Next(*source)).status == ReadStatus::kFrame; ++count) {
    EXPECT_EQ(result.frame.depth_mm.size(), 640u * 480u);
    EXPECT_EQ(result.dropped, 0);
  }
  EXPECT_EQ(count, 8);
}

}  // namespace
}  // namespace ossa::depth
