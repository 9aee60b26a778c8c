// The camera of a folder or data set: by option, from files of many programs, or by image size.
#include <gtest/gtest.h>

#include <fstream>

#include "depth/base/error.h"
#include "depth/image/camera_io.h"
#include "depth/image/depth_png.h"
#include "depth/sensor/frame_source.h"
#include "tests/depth/sensor/folder_frames.h"
#include "tests/support/temporary_folder.h"

namespace ossa::depth {
namespace {

using test::Next;
using test::Notes;
using test::TemporaryFolder;
using test::WriteFrame;

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

// A guess without a known image size is hardly right, and is told even where notes are not.
TEST(FolderSource, WarnsOfACameraAssumedForAnUnknownImageSize) {
  const TemporaryFolder folder;
  SourceOptions options;
  std::vector<NoteKind> kinds;
  options.note = [&](NoteKind kind, const std::string&) { kinds.push_back(kind); };
  for (const auto& [width, height] : {std::pair{640, 400}, std::pair{160, 120}}) {
    const Image<uint16_t> image(width, height, 1000);
    WriteDepthPng(folder / "0.png", {image.data.data(), width, height, width});
    OpenSource(folder.path().string(), options);
  }
  EXPECT_EQ(kinds, (std::vector{NoteKind::kWarning, NoteKind::kInfo}));
}

TEST(FolderSource, WarnsOfIntrinsicsThatAreNotInPixels) {
  const TemporaryFolder folder;
  WriteFrame(folder / "0.png", 1, 64, 48);
  for (const auto& [camera, is_told] : {std::pair{"0.9,1.2,0.5,0.5", true},
                                        {"5750,5750,320,240", true},
                                        {"57.5,57.5,32,24", false}}) {
    Notes notes;
    SourceOptions options = notes.Options();
    options.camera = ParseCamera(camera);
    OpenSource(folder.path().string(), options);
    EXPECT_EQ(notes.Tell("no depth camera has f"), is_told) << camera << notes.text;
  }
}

TEST(FolderSource, UnmirrorsImagesAndTheirCamera) {
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

// Presets, by name or by image size, describe the sensor, not the stored images.
TEST(FolderSource, PresetsAreTheSameForMirroredImages) {
  const TemporaryFolder folder;
  WriteFrame(folder / "0.png", 1);
  EXPECT_EQ(OpenSource(folder.path().string(), {.mirrored = true})->camera(), KinectV1Camera(8, 6));
  const SourceOptions options{.camera = ParseCamera("kinect-v2"), .mirrored = true};
  EXPECT_EQ(OpenSource(folder.path().string(), options)->camera(), PresetCamera("kinect-v2", 8, 6));
}

TEST(FolderSource, NotesACameraGuessedFromTheImageSize) {
  const TemporaryFolder folder;
  WriteFrame(folder / "0.png", 1, 512, 424);
  Notes notes;
  const auto source = OpenSource(folder.path().string(), notes.Options());
  EXPECT_EQ(source->camera().fx, 366.0);
  EXPECT_TRUE(notes.Tell("kinect-v2 (f 366 px) is assumed for images of 512x424")) << notes.text;
}

// Folder layout of Open3D's recorders.
TEST(FolderSource, ReadsAnOpen3dCameraInTheParentFolder) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "depth");
  WriteFrame(folder / "depth/000000.png", 1, 640, 480);
  std::ofstream(folder / "camera_intrinsic.json")
      << R"({"width": 640, "height": 480, "intrinsic_matrix": [612.5, 0, 0, 0, 611, 0, 322, 237, 1]})";
  Notes notes;
  const auto source = OpenSource((folder / "depth/").string(), notes.Options());
  EXPECT_EQ(source->camera(), (Camera{640, 480, 612.5, 611.0, 322.0, 237.0}));
  EXPECT_TRUE(notes.Tell("camera_intrinsic.json: its camera is used")) << notes.text;
  std::ofstream(folder / "camera_intrinsic.json") << R"({"focal": 612.5})";
  Notes others;
  EXPECT_EQ(OpenSource((folder / "depth").string(), others.Options())->camera().fx, 575.0);
  EXPECT_TRUE(others.Tell("camera_intrinsic.json: ignored: ")) << others.text;
}

// Folder layout of scene data sets.
TEST(FolderSource, ReadsACameraMatrixIfItsCentreFitsTheImage) {
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

// Folder layout of ScanNet's exporter, beside it the colours.
TEST(FolderSource, OpensTheDepthFolderOfAScan) {
  const TemporaryFolder folder;
  for (const char* name : {"depth", "color", "intrinsic"}) {
    std::filesystem::create_directory(folder / name);
  }
  WriteFrame(folder / "depth/0.png", 7, 640, 480);
  EXPECT_FALSE(IsRecording(folder.path()));
  EXPECT_THROW(OpenSource(folder.path().string()), InputError) << "the camera is not known";
  std::ofstream(folder / "intrinsic/intrinsic_depth.txt")
      << "577.5 0 319 0\n0 578 240 0\n0 0 1 0\n0 0 0 1\n";
  EXPECT_TRUE(IsRecording(folder.path()));
  const auto source = OpenSource(folder.path().string());
  EXPECT_EQ(source->camera(), (Camera{640, 480, 577.5, 578.0, 319.0, 240.0}));
  EXPECT_EQ(Next(*source).frame.depth_mm.front(), 7);
  WriteFrame(folder / "0.png", 9, 640, 480);
  EXPECT_EQ(Next(*OpenSource(folder.path().string())).frame.depth_mm.front(), 9)
      << "images of its own";
}

TEST(FolderSource, WarnsOfAChosenCameraWhoseCentreIsAnothers) {
  const TemporaryFolder folder;
  WriteFrame(folder / "0.png", 1, 320, 240);
  Notes notes;
  SourceOptions options = notes.Options();
  options.camera = ParseCamera("290,290,158,125");
  OpenSource(folder.path().string(), options);
  EXPECT_FALSE(notes.Tell("the centre of the camera")) << notes.text;
  options.camera = ParseCamera("577,577,319,240");
  OpenSource(folder.path().string(), options);
  EXPECT_TRUE(notes.Tell("the centre of the camera, 319,240, is not that of images of 320x240"))
      << notes.text;
}

TEST(FolderSource, ReadsARosCalibrationAndNotesItsDistortion) {
  const TemporaryFolder folder;
  WriteFrame(folder / "0.png", 1, 640, 480);
  std::ofstream(folder / "ost.yaml")
      << "image_width: 640\nimage_height: 480\n"
         "camera_matrix:\n  rows: 3\n  data: [600, 0, 320, 0, 601, 240, 0, 0, 1]\n"
         "distortion_coefficients:\n  data: [-0.3, 0.1, 0, 0, 0]\n";
  Notes notes;
  const auto source = OpenSource(folder.path().string(), notes.Options());
  EXPECT_EQ(source->camera(), (Camera{640, 480, 600, 601, 320, 240}));
  EXPECT_TRUE(notes.Tell("ost.yaml: its camera is used")) << notes.text;
  EXPECT_TRUE(notes.Tell("ost.yaml: the lens moves the image's corners by ")) << notes.text;
}

TEST(FolderSource, WarnsOfACameraOfAnotherAspectRatio) {
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

// A data set of one image, with a camera in its manifest.
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

TEST_F(DataSetSource, UsesTheManifestsCameraAndTheDepthFolder) {
  const auto source = OpenSource(folder_.path().string());
  EXPECT_EQ(source->camera(), kCamera);
  EXPECT_EQ(Next(*source).frame.depth_mm[0], 42);
  EXPECT_EQ(CameraOf("depth/000000.png"), kCamera);
}

TEST_F(DataSetSource, SingleImageHasTheDataSetsCameraForAnySpellingOfThePath) {
  for (const char* name : {"depth/./000000.png", "depth/../depth/000000.png"}) {
    EXPECT_EQ(CameraOf(name), kCamera) << name;
  }
}

}  // namespace
}  // namespace ossa::depth
