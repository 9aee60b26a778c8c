# The two OpenCV libraries ossa uses. Debian keeps OpenCVConfig.cmake in libopencv-dev, which pulls
# in 700 MB; the small packages of core and imgproc come without it, so they are found here. Their
# static libraries are taken where they are: of the shared ones core needs OpenGL, and with that LLVM,
# 225 MB in all, of which pictures draw lines.
find_path(OpenCV_INCLUDE opencv2/core.hpp PATH_SUFFIXES opencv4)
set(OpenCV_FOUND_ALL TRUE)
foreach(module core imgproc)
  find_library(OpenCV_${module}_LIBRARY NAMES libopencv_${module}.a opencv_${module})
  if(NOT OpenCV_${module}_LIBRARY OR NOT OpenCV_INCLUDE)
    set(OpenCV_FOUND_ALL FALSE)
  elseif(NOT TARGET opencv_${module})
    add_library(opencv_${module} UNKNOWN IMPORTED)
    set_target_properties(opencv_${module} PROPERTIES IMPORTED_LOCATION ${OpenCV_${module}_LIBRARY}
                          INTERFACE_INCLUDE_DIRECTORIES ${OpenCV_INCLUDE})
    if(OpenCV_${module}_LIBRARY MATCHES "[.]a$")  # each of ours has what it uses, for itself, without OpenGL
      target_link_options(opencv_${module} INTERFACE "-Wl,--exclude-libs,libopencv_${module}.a" -Wl,--gc-sections
                          -Wl,--defsym=glXGetProcAddressARB=0 -Wl,--defsym=glXGetCurrentContext=0
                          -Wl,--defsym=glXGetCurrentDisplay=0)
      target_link_libraries(opencv_${module} INTERFACE TBB::tbb)
    endif()
  endif()
endforeach()
if(OpenCV_FOUND_ALL)  # a linker that reads archives once, as GNU ld does, wants core behind what uses it
  set_property(TARGET opencv_imgproc APPEND PROPERTY INTERFACE_LINK_LIBRARIES opencv_core)
endif()
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OpenCVLite REQUIRED_VARS OpenCV_INCLUDE OpenCV_FOUND_ALL)
