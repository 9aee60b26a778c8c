# Writes OUT, a C++ source with the files of the page, gzipped: how browsers want them, and a quarter of
# the size. FILES is a list of PATH=FILE, PATH that of the request.
#   cmake -DOUT=page_files.cpp "-DFILES=/page/index.html=...;..." -P embed_page.cmake
set(arrays "")
set(entries "")
set(number 0)
foreach(entry IN LISTS FILES)
  string(REGEX MATCH "^([^=]*)=(.*)$" unused "${entry}")
  set(path ${CMAKE_MATCH_1})
  set(file ${CMAKE_MATCH_2})
  cmake_path(GET file EXTENSION LAST_ONLY extension)
  if(extension STREQUAL ".html")
    set(type "text/html")
  elseif(extension STREQUAL ".css")
    set(type "text/css")
  else()
    set(type "text/javascript")
  endif()
  file(ARCHIVE_CREATE OUTPUT ${OUT}.gz PATHS ${file} FORMAT raw COMPRESSION GZip COMPRESSION_LEVEL 9)
  file(READ ${OUT}.gz bytes HEX)
  file(REMOVE ${OUT}.gz)
  string(LENGTH ${bytes} digits)
  math(EXPR size "${digits} / 2")
  string(REGEX REPLACE "(..)" "0x\\1," bytes ${bytes})
  string(REGEX REPLACE "(................................................................................)" "\\1\n" bytes ${bytes})
  string(APPEND arrays "constexpr unsigned char kFile${number}[] = {\n${bytes}};\n")
  string(APPEND entries "    {\"${path}\", \"${type}\", Text(kFile${number}, ${size})},\n")
  math(EXPR number "${number} + 1")
endforeach()
file(WRITE ${OUT} "// Written by embed_page.cmake.
#include <cstddef>

#include \"tools/viewer/page_files_internal.h\"

namespace ossa::viewer {
namespace {

${arrays}
std::string_view Text(const unsigned char* bytes, size_t size) {
  return {reinterpret_cast<const char*>(bytes), size};
}

}  // namespace

const PageFile* FindPageFile(std::string_view path) {
  static const PageFile kFiles[] = {
${entries}  };
  for (const PageFile& file : kFiles) {
    if (file.path == path) return &file;
  }
  return nullptr;
}

}  // namespace ossa::viewer
")
