#pragma once
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "recon/skeleton_sequence.h"
#include "tools/viewer/display_frame.h"

namespace ossa::forest {
class ForestModel;  // forest/forest.h
}
namespace ossa::recon {
struct BodyMesh;  // recon/fit/body_mesh.h
}

namespace ossa::viewer {

// Constants: ports and addresses by convention.

/// Settings that a page may change while frames come.
struct Settings {
  std::string method;     // one of ViewerOptions::methods
  std::string smoothing;  // one of ViewerOptions::smoothings; empty: the default of the method
  bool seated = false;
  bool near_range = false;
  int users = 6;  // most people at a time, 1 to 6: the Kinect SDK's bounds
  bool operator==(const Settings&) const = default;
};

/// Skeletons shown over the tracker's: truth, or those of another program.
struct Overlay {
  std::string name;
  recon::SkeletonSequence sequence;
};

/// Options of the server and of the shown content.
struct ViewerOptions {
  int port = 8080;                    // 0: any free one
  std::string address = "127.0.0.1";  // an IP address of this machine
  /// Grants access; needed for addresses that other machines reach; empty: none.
  std::string token;
  /// A recording: every frame can be shown again. False, a camera: the newest frame is shown.
  bool keeps = false;
  std::optional<int64_t> expected_frames = {};  // of a recording, if known
  std::string name;                             // of the source, as a title
  std::vector<Overlay> overlays;
  /// Finds body parts of frames without them, on the thread of the server and only for frames that
  /// a page requests. Null: none are found.
  std::shared_ptr<const forest::ForestModel> forest;
  /// The skin of fitted bodies, and of an exported .glb. Null: bodies are not shown.
  std::shared_ptr<const recon::BodyMesh> body;
  /// Left out: nothing can be changed.
  std::optional<Settings> settings = {};
  std::vector<std::string> methods, smoothings;
  /// Folder of recordings that pages start. Left out: pages cannot record.
  std::optional<std::filesystem::path> recordings = {};
};

/// The page of docs/viewer.md: depth images, body parts and skeletons, for any number of browsers.
/// /skeletons has the skeletons alone as server-sent events, a line of skeleton JSONL each, for
/// other programs. Serves on its own thread.
class Viewer {
 public:
  /// Throws InputError when the address is invalid or the port is taken.
  explicit Viewer(const ViewerOptions& options);
  ~Viewer();

  int port() const;
  /// Addresses for browsers, one per network, with the token.
  std::vector<std::string> urls() const;

  /// The next frame; never waits for a browser. Throws InputError where a recording's frames do
  /// not fit on the disk.
  void Show(DisplayFrame display);
  /// Of a recording: all frames were shown.
  void Complete();
  /// The recording will be shown again from its first frame on.
  void Clear();
  /// Settings that a page changed since the last call; from now on pages show them as current.
  std::optional<Settings> TakeSettings();
  /// The changed settings cannot be used: shows `why` on the pages; `still` stays current.
  void Refuse(const Settings& still, const std::string& why);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// A random token of 32 hexadecimal digits.
std::string RandomToken();

}  // namespace ossa::viewer
