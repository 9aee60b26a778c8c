# The two OpenCV libraries ossa uses. Debian keeps OpenCVConfig.cmake in libopencv-dev, which pulls
# in 700 MB; the small packages of core and imgproc come without it, so they are found here.
find_path(OpenCV_INCLUDE opencv2/core.hpp PATH_SUFFIXES opencv4)
set(OpenCV_FOUND_ALL TRUE)
foreach(module core imgproc)
  find_library(OpenCV_${module}_LIBRARY opencv_${module})
  if(NOT OpenCV_${module}_LIBRARY OR NOT OpenCV_INCLUDE)
    set(OpenCV_FOUND_ALL FALSE)
  elseif(NOT TARGET opencv_${module})
    add_library(opencv_${module} UNKNOWN IMPORTED)
    set_target_properties(opencv_${module} PROPERTIES IMPORTED_LOCATION ${OpenCV_${module}_LIBRARY}
                          INTERFACE_INCLUDE_DIRECTORIES ${OpenCV_INCLUDE})
  endif()
endforeach()
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OpenCVLite REQUIRED_VARS OpenCV_INCLUDE OpenCV_FOUND_ALL)
