# Every third-party package in one place; the rooms link the targets they need, PRIVATE.
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(OpenCVLite REQUIRED)  # targets opencv_core, opencv_imgproc
find_package(PNG REQUIRED)
find_package(embree 3.13 REQUIRED)
find_package(Ceres 2.1 REQUIRED)
find_package(TBB REQUIRED)

find_package(CLI11 2.1 REQUIRED)
find_package(nlohmann_json 3.11 REQUIRED)
find_package(fmt REQUIRED)
find_package(Threads REQUIRED)
find_package(ZLIB REQUIRED)
find_package(Boost 1.74 REQUIRED)  # Beast and Asio: headers alone
find_package(PkgConfig REQUIRED)
pkg_check_modules(openni2 REQUIRED IMPORTED_TARGET libopenni2)
pkg_check_modules(ode REQUIRED IMPORTED_TARGET ode)
pkg_check_modules(xxhash REQUIRED IMPORTED_TARGET libxxhash)
pkg_check_modules(archive REQUIRED IMPORTED_TARGET libarchive)
pkg_check_modules(zstd REQUIRED IMPORTED_TARGET libzstd)
pkg_check_modules(freenect QUIET IMPORTED_TARGET libfreenect)
pkg_check_modules(libav QUIET IMPORTED_TARGET libavformat libavcodec libavutil)  # .mkv
include(ossa_rosbag)
find_package(TinyGLTF QUIET CONFIG)  # skinned people in motion
if(NOT TinyGLTF_FOUND)
  message(STATUS "--out FILE.glb is left out: libtinygltf-dev is not installed")
endif()
find_package(meshoptimizer QUIET CONFIG)  # the skin of `ossa surface --mesh`
if(NOT meshoptimizer_FOUND)
  message(STATUS "ossa surface --mesh is left out: libmeshoptimizer-dev is not installed")
endif()
find_library(OSCPACK_LIBRARY oscpack)  # live output to avatars' programs
if(NOT OSCPACK_LIBRARY)
  message(STATUS "--send vmc:// and vrchat:// are left out: liboscpack-dev is not installed")
endif()
if(OSSA_PYTHON AND NOT OSSA_SANITIZE)  # a sanitizer must be in the interpreter first
  if(NOT SKBUILD AND NOT Python_EXECUTABLE AND EXISTS /usr/bin/python3)
    set(Python_EXECUTABLE /usr/bin/python3)  # Debian's own, which has Debian's packages
  endif()
  find_package(Python 3.9 QUIET COMPONENTS Interpreter Development.Module)
  find_package(pybind11 2.10 QUIET CONFIG)
  if(NOT Python_FOUND OR NOT pybind11_FOUND)
    message(STATUS "The Python package is left out: python3-dev or pybind11-dev is not installed")
  endif()
endif()
if(OSSA_MPI)
  find_package(MPI QUIET COMPONENTS CXX)
endif()
