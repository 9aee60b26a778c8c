#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "tools/viewer/shared_state_internal.h"

namespace ossa::viewer {

/// The answer to a request.
struct Answer {
  unsigned status = 200;  // of HTTP
  std::string type = "text/plain; charset=utf-8";
  std::string body = {};
  bool gzipped = false;
  std::string file_name = {};  // name under which a browser saves it; empty: the browser shows it
};

/// The value of `key` in the query of a request's target; empty without one. Not decoded: all
/// values that ossa reads are plain words and numbers.
std::string QueryValue(std::string_view target, std::string_view key);

/// Answers GET `target`:
///   /, /page/NAME, /three/...       the page and what it loads
///   /state                          the state as JSON
///   /lines?layer=L&from=N&count=M   skeletons, "final" or the number of an overlay: JSONL
///   /export?format=F&from=N&to=M    the final skeletons of frames N to M: jsonl, csv, trc, bvh or
///                                   glb
///   /mesh                           vertex indices of the triangles of fitted bodies: uint32 x 3,
///                                   little-endian; nothing where no bodies are shown
/// 404 for other targets, 400 with one line for invalid values.
Answer AnswerTo(std::string_view target, const SharedState& shared);

}  // namespace ossa::viewer
