#pragma once
#include <string_view>

namespace ossa::viewer {

/// A file of the page, as it was built in (embed_page.cmake).
struct PageFile {
  std::string_view path;     // of the request
  std::string_view type;     // of its content
  std::string_view gzipped;  // the content
};

/// Null where there is none of that path.
const PageFile* FindPageFile(std::string_view path);

}  // namespace ossa::viewer
