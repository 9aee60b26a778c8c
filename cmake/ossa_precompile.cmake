# With OSSA_PRECOMPILE the headers that most sources include are parsed once for all libraries and
# once for all tests: a quarter less work for tests/run's second build. Every source still includes
# what it uses; the plain build, made without it, checks that.
set(ossa_precompiled_headers
  <algorithm> <array> <cmath> <cstdint> <filesystem> <fstream> <functional> <map> <memory> <optional>
  <random> <span> <sstream> <string> <vector> <Eigen/Core> <Eigen/Geometry>)

# ossa_precompile(TARGET OWNER): TARGET takes the headers from OWNER, which is compiled in the same way:
# ossa_library_headers (position-independent) or ossa_test_headers (an executable's, and GoogleTest).
function(ossa_precompile target owner)
  if(NOT OSSA_PRECOMPILE)
    return()
  endif()
  if(NOT TARGET ${owner})
    set(source ${ossa_BINARY_DIR}/${owner}.cpp)
    file(CONFIGURE OUTPUT ${source} CONTENT "int main() { return 0; }\n")
    if(owner STREQUAL ossa_test_headers)
      add_executable(${owner} ${source})
      target_link_libraries(${owner} PRIVATE Eigen3::Eigen GTest::gtest)
      target_precompile_headers(${owner} PRIVATE ${ossa_precompiled_headers} <gtest/gtest.h>)
      ossa_plain(${owner})
    else()
      add_library(${owner} OBJECT ${source})
      target_link_libraries(${owner} PRIVATE Eigen3::Eigen)
      target_precompile_headers(${owner} PRIVATE ${ossa_precompiled_headers})
      ossa_common(${owner})
    endif()
  endif()
  target_precompile_headers(${target} REUSE_FROM ${owner})
endfunction()
