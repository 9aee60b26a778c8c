#pragma once
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "recon/skeleton_sequence.h"
#include "tools/viewer/moment.h"

namespace ossa::forest {
class ForestModel;  // forest/forest.h
}
namespace ossa::recon {
struct BodyMesh;  // recon/fit/body_mesh.h
}

namespace ossa::viewer {

// Constants: ports and addresses by convention.

/// What a page may change while frames come.
struct Settings {
  std::string method;     // one of ViewerOptions::methods
  std::string smoothing;  // one of ViewerOptions::smoothings; empty: what goes with the method
  bool seated = false;
  bool near_range = false;
  int users = 6;  // most people at a time, 1 to 6: the Kinect SDK's bounds
  bool operator==(const Settings&) const = default;
};

/// Skeletons to see over those that are shown: truth, another program's.
struct Overlay {
  std::string name;
  recon::SkeletonSequence sequence;
};

/// How a Viewer serves, and what of.
struct ViewerOptions {
  int port = 8080;                    // 0: any free one
  std::string address = "127.0.0.1";  // an IP address of this machine
  /// Whoever knows it may look: needed for addresses that other machines reach; empty: none.
  std::string token;
  /// A recording: every frame can be shown again. False, a camera: the newest frame is shown.
  bool keeps = false;
  std::optional<int64_t> expected_frames = {};  // of a recording that knows
  std::string name;                             // of what is shown, for people to read
  std::vector<Overlay> overlays;
  /// Finds body parts for frames that come without, on the page's thread and only for frames that
  /// somebody looks at. Null: none are found.
  std::shared_ptr<const forest::ForestModel> forest;
  /// The skin of fitted bodies, and of an exported .glb. Null: bodies are not shown.
  std::shared_ptr<const recon::BodyMesh> body;
  /// Left out: nothing can be changed.
  std::optional<Settings> settings = {};
  std::vector<std::string> methods, smoothings;
  /// Where recordings that a page asks for go. Left out: none can be asked for.
  std::optional<std::filesystem::path> recordings = {};
};

/// The page of docs/viewer.md: depth images, what is seen in them, and their skeletons, for any
/// number of browsers. /skeletons are the skeletons alone as server-sent events, a line of skeleton
/// JSONL each, for other programs. Serves from a thread of its own.
class Viewer {
 public:
  /// Throws InputError when the address is none or the port is taken.
  explicit Viewer(const ViewerOptions& options);
  ~Viewer();

  int port() const;
  /// Where browsers find it, one address a network; with the token.
  std::vector<std::string> urls() const;

  /// The next moment; never waits for a browser. Throws InputError where a recording's frames do
  /// not fit on the disk.
  void Show(Moment moment);
  /// Of a recording: all frames were shown.
  void Complete();
  /// Of a recording: it will be shown anew from its first frame on.
  void Clear();
  /// What a page asked for since it was asked last; the page shows them as they are from now on.
  std::optional<Settings> TakeSettings();
  /// What was asked for cannot be: says why to the pages; `still` holds.
  void Refuse(const Settings& still, const std::string& why);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// A token nobody guesses, 32 hexadecimal digits.
std::string RandomToken();

}  // namespace ossa::viewer
