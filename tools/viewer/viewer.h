#pragma once
#include <memory>

#include "depth/image/depth_frame.h"
#include "recon/skeleton_sequence.h"

namespace ossa::viewer {

/// A small web page on 127.0.0.1 that shows the newest depth image and its skeletons, from the
/// front and from above; /skeletons are the skeletons alone as server-sent events, a line of
/// skeleton JSONL each, for other programs. Serves from threads of its own; nobody outside this
/// machine sees it.
class Viewer {
 public:
  /// Port 0 takes any free one. Throws InputError when the port is taken.
  explicit Viewer(int port);
  ~Viewer();

  int port() const;
  /// Replaces what is shown; never waits for a browser.
  void Show(const depth::DepthFrame& frame, const recon::SkeletonFrame& skeletons);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ossa::viewer
