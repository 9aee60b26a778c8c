#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "depth/image/depth_png.h"
#include "tests/support/run_command.h"
#include "tests/tools/tracker/tracked_scenes.h"

/// Folders of PNGs for `ossa track`.
namespace ossa::commands {

/// A person who walks sideways, as a PNG folder.
inline void WriteWalk(const std::filesystem::path& folder, int frames) {
  std::filesystem::create_directories(folder);
  for (int i = 0; i < frames; ++i) {
    const auto render = tracker::Rendered({tracker::PersonAt(-0.3 + 0.03 * i, 2.6)}, i);
    std::string name = std::to_string(1000000 + i).substr(1);
    name.append(".png");
    depth::WriteDepthPng(folder / name, render.frame.view());
  }
}

/// A wall.
inline void WriteFlat(const std::filesystem::path& folder, uint16_t depth_mm, int frames) {
  for (int i = 0; i < frames; ++i) {
    depth::DepthFrame frame;
    frame.camera = depth::KinectV1Camera(160, 120);
    frame.depth_mm.assign(160 * 120, depth_mm);
    std::string name = std::to_string(100 + i);
    name.append(".png");
    depth::WriteDepthPng(folder / name, frame.view());
  }
}

/// `ossa track` of a source to a file.
inline test::CommandResult TrackTo(const std::filesystem::path& source,
                                   const std::filesystem::path& out,
                                   const std::vector<std::string>& more = {},
                                   const std::string& method = "none") {
  std::vector<std::string> arguments = {"track",      source.string(), "--out",
                                        out.string(), "--method",      method};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return test::RunOssa(arguments);
}

}  // namespace ossa::commands
