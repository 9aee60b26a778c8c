#pragma once
#include <filesystem>
#include <memory>
#include <string>

#include "depth/sensor/frame_source.h"
#include "depth/sensor/oni_format_internal.h"

namespace ossa::depth {

/// A folder of 16-bit PNGs, ordered and timed as ListDepthFolder says. A frame number that is
/// missing counts as a dropped frame, and time passes. Frames that cannot be read, or are of
/// another size than most, are skipped, count as dropped, and are told of at the end; where there
/// is no other, the first one's InputError is thrown.
std::unique_ptr<FrameSource> OpenFolder(const std::filesystem::path& folder,
                                        const SourceOptions& options);

/// One 16-bit PNG: a recording of a single frame. Camera as of the folder or data set it is in.
std::unique_ptr<FrameSource> OpenStill(const std::filesystem::path& png,
                                       const SourceOptions& options);

/// A data set: manifest.json, depth/ and more (docs/architecture.md, "Data set").
bool IsDataSet(const std::filesystem::path& folder);
std::unique_ptr<FrameSource> OpenDataSet(const std::filesystem::path& folder,
                                         const SourceOptions& options);

/// An .oni recording, played by OpenNI2 in a child process: a file that crashes or hangs the
/// library is an InputError here, at opening or at the frame where it happens.
std::unique_ptr<FrameSource> OpenOniFile(const std::filesystem::path& path,
                                         const SourceOptions& options);

/// An Azure Kinect's or a Femto's recording: depth undistorted by the calibration in it. Read by
/// libavformat in a child process.
std::unique_ptr<FrameSource> OpenMkvFile(const std::filesystem::path& path,
                                         const SourceOptions& options);

/// A ROS 1 bag; topic "": the one named after depth. Read by rosbag_storage in a child process.
std::unique_ptr<FrameSource> OpenBagFile(const std::filesystem::path& path,
                                         const std::string& topic, const SourceOptions& options);

/// `options.camera` for images of this size. Presets are of the sensor as it looks: where images
/// are mirrored, of these, as any other camera of them is.
Camera ChosenCamera(const SourceOptions& options, int width, int height);

/// The camera whose images have this size, of mirrored ones likewise; says in a note which was
/// taken for whose.
Camera CameraByImageSize(const std::string& name, int width, int height,
                         const SourceOptions& options);

/// Of files that ossa does not read, by their extension: what they are and what makes ones of them
/// that it does; null of others.
const char* HowToConvert(const std::filesystem::path& file);

/// Whether a source says what its numbers are.
enum class UnitStated { kNo, kYes };

/// The source with numbers and times as the options say. Without them, InputError where the first
/// frames of a source that states no unit cannot be millimetres of people.
std::unique_ptr<FrameSource> Prepared(const std::string& name, std::unique_ptr<FrameSource> source,
                                      UnitStated unit, const SourceOptions& options);

/// The source's images and cameras with left and right exchanged (SourceOptions::mirrored). Last of
/// all: lenses and windows of its images are stated of them as they lie in it.
std::unique_ptr<FrameSource> UnmirroredSource(std::unique_ptr<FrameSource> source);

/// One of ours without an end (OniFile::unfinished), of which the options' note is told: its whole
/// frames. A frame whose bytes are damaged throws InputError; reading again goes on with the next.
std::unique_ptr<FrameSource> OpenUnfinishedOni(const std::filesystem::path& path, OniFile recording,
                                               const SourceOptions& options);

/// A device; an empty URI means the first found.
std::unique_ptr<FrameSource> OpenOpenNiDevice(const std::string& uri, const SourceOptions& options);

}  // namespace ossa::depth
