#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "depth/image/depth_png.h"
#include "depth/sensor/frame_source.h"
#include "depth/sensor/oni_format_internal.h"

namespace ossa::depth {

/// A folder of depth images (IsDepthFileName), ordered and timed by ListDepthFolder. Missing frame
/// numbers count as dropped frames, and time passes. Frames that are unreadable or of another size
/// than most are skipped, counted as dropped, and reported at the end; if there are no others, the
/// first one's InputError is thrown.
std::unique_ptr<FrameSource> OpenFolder(const std::filesystem::path& folder,
                                        const SourceOptions& options);

/// One depth image: a recording of one frame. The camera is that of its folder or data set.
std::unique_ptr<FrameSource> OpenStill(const std::filesystem::path& image,
                                       const SourceOptions& options);

/// Whether the principal point is as near to the middle of the images as that of depth cameras.
bool IsCentreNear(const Camera& camera);

/// A data set: manifest.json, depth/ and more (docs/architecture.md, "Data set").
bool IsDataSet(const std::filesystem::path& folder);
std::unique_ptr<FrameSource> OpenDataSet(const std::filesystem::path& folder,
                                         const SourceOptions& options);

/// Whether the images of this folder are in its folder `depth`, as in a scan of ScanNet or a
/// recording of Open3D: the camera of that folder is here or in `intrinsic`, and there is no image.
bool HoldsDepthFolder(const std::filesystem::path& folder);

/// An .oni recording, played by OpenNI2 in a child process: if a file makes the library crash or
/// hang, that is an InputError, at opening or at the frame where it happens.
std::unique_ptr<FrameSource> OpenOniFile(const std::filesystem::path& path,
                                         const SourceOptions& options);

/// An Azure Kinect or Femto recording: depth undistorted by its calibration. Read by libavformat in
/// a child process.
std::unique_ptr<FrameSource> OpenMkvFile(const std::filesystem::path& path,
                                         const SourceOptions& options);

/// A ROS 1 bag; topic "": chosen automatically. Read by rosbag_storage in a child process.
std::unique_ptr<FrameSource> OpenBagFile(const std::filesystem::path& path,
                                         const std::string& topic, const SourceOptions& options);

/// A ROS 2 bag, a file or a folder (recording_name_internal.h), by a reader of .db3 and .mcap in a
/// child process.
std::unique_ptr<FrameSource> OpenRos2Bag(const std::filesystem::path& path,
                                         const std::string& topic, const SourceOptions& options);

/// A recording of Kinect Studio (xef_file.h), as it is: mirrored.
std::unique_ptr<FrameSource> OpenXefFile(const std::filesystem::path& path,
                                         const SourceOptions& options);

/// PGM images one after the other (IsStream, or a file that HoldsSeveralPgms): waits for the first
/// one. A comment in an image's header may state its time, "# time_s SECONDS", and its camera,
/// "# camera FX,FY,CX,CY". Without: it is when the image arrives (of a file, 30 a second), and the
/// camera beside a file or by the size.
std::unique_ptr<FrameSource> OpenImageStream(const std::string& source,
                                             const SourceOptions& options);
bool HoldsSeveralPgms(const std::filesystem::path& path);

/// The pages of a TIFF file, 30 images a second, the camera beside it as that of a still. Damaged
/// ones are skipped, counted as dropped, and reported at the end.
std::unique_ptr<FrameSource> OpenTiffPages(const std::filesystem::path& path,
                                           const SourceOptions& options);
bool HoldsSeveralPages(const std::filesystem::path& path);

/// A depth file of MSR Daily Activity 3D or MSR Action3D, recognised by its counts and its size; 30
/// images a second, the camera beside it as that of a still.
bool IsMsrDepthFile(const std::filesystem::path& path);
std::unique_ptr<FrameSource> OpenMsrDepthFile(const std::filesystem::path& path,
                                              const SourceOptions& options);

/// Arrays of NumPy, MATLAB or HDF5 (IsArrayName); array "": chosen by its name and shape. Read in a
/// child process. The camera beside the file is that of a still.
std::unique_ptr<FrameSource> OpenArrayFile(const std::filesystem::path& path,
                                           const std::string& array, const SourceOptions& options);

/// The camera by a file in a folder of such images: camera.json, or as others have it; none without
/// one. Throws InputError for a damaged camera.json.
std::optional<Camera> CameraFileIn(const std::filesystem::path& folder, ImageSize size,
                                   const SourceOptions& options);

/// The camera of images: by option, else by a file in their folder (unless that is ""), else by
/// their size.
Camera FileCamera(const std::string& name, const std::filesystem::path& folder, ImageSize size,
                  const SourceOptions& options);

/// `options.camera` for images of this size. Presets describe the unmirrored sensor; for mirrored
/// images they are mirrored, like all cameras of such images.
Camera ChosenCamera(const SourceOptions& options, int width, int height);

/// The preset camera with this image size, mirrored for mirrored images; notes which one was
/// assumed.
Camera CameraByImageSize(const std::string& name, int width, int height,
                         const SourceOptions& options);

/// For unsupported files, by extension: the format, and how to convert it; null for others.
const char* DescribeConversion(const std::filesystem::path& file);

/// Whether a source states the unit of its values.
enum class UnitStated { kNo, kYes };

/// The source with values and times converted by the options. Without options, throws InputError if
/// the first frames of a source without a stated unit cannot be millimetres of people.
std::unique_ptr<FrameSource> Prepared(const std::string& name, std::unique_ptr<FrameSource> source,
                                      UnitStated unit, const SourceOptions& options);

/// The source's images and cameras with left and right exchanged (SourceOptions::mirrored). Must be
/// the outermost wrapper: distortion and windows refer to the stored images.
std::unique_ptr<FrameSource> UnmirroredSource(std::unique_ptr<FrameSource> source);

/// One of our unfinished recordings (OniFile::unfinished), which is noted: its complete frames. A
/// frame with damaged bytes throws InputError; reading can continue with the next.
std::unique_ptr<FrameSource> OpenUnfinishedOni(const std::filesystem::path& path, OniFile recording,
                                               const SourceOptions& options);

/// A device; an empty URI selects the first one.
std::unique_ptr<FrameSource> OpenOpenNiDevice(const std::string& uri, const SourceOptions& options);

}  // namespace ossa::depth
