# `cmake --build BUILD --target package` makes Debian packages, split by use (docs/install.md): ossa,
# ossa-tools, ossa-readers, ossa-nite2, python3-ossa and libossa-dev. What they depend on outside of ossa is
# read from the binaries.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME ossa)
set(CPACK_PACKAGE_VENDOR "the ossa authors")
set(CPACK_PACKAGE_CONTACT "the ossa authors <ossa@example.org>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_LIBRARY_OUTPUT_DIRECTORY})
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
    WORLD_READ WORLD_EXECUTE)

# Without its time, so that the same sources are the same bytes.
find_program(GZIP gzip REQUIRED)
set(changelog ${PROJECT_BINARY_DIR}/debian/changelog.gz)
file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/debian)
execute_process(COMMAND ${GZIP} -9nc ${PROJECT_SOURCE_DIR}/cmake/debian/changelog OUTPUT_FILE ${changelog}
                COMMAND_ERROR_IS_FATAL ANY)

# ossa_package(COMPONENT PACKAGE SECTION DESCRIPTION [DEPENDS text] [SUGGESTS text]): of a component a package. The first
# line of the description sums it up.
function(ossa_package component package section description)
  cmake_parse_arguments(ARG "" "DEPENDS;SUGGESTS" "" ${ARGN})
  string(TOUPPER ${component} upper)
  set(CPACK_COMPONENTS_ALL ${CPACK_COMPONENTS_ALL} ${component} PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${package} PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION ${section} PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_DESCRIPTION "${description}" PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_PACKAGE_DEPENDS "${ARG_DEPENDS}" PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_PACKAGE_SUGGESTS "${ARG_SUGGESTS}" PARENT_SCOPE)
  install(FILES ${PROJECT_SOURCE_DIR}/cmake/debian/copyright ${changelog}
          DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package} COMPONENT ${component})
endfunction()
foreach(component RUNTIME TOOLS)  # libraries where every program finds them
  set(CPACK_DEBIAN_${component}_PACKAGE_CONTROL_EXTRA ${PROJECT_SOURCE_DIR}/cmake/debian/triggers)
endforeach()
set(CPACK_COMPONENTS_ALL)
set(same "(= ${PROJECT_VERSION})")
ossa_package(runtime ossa science "skeletons of people from depth images
Tracks the 20 Kinect SDK joints of up to six people in depth images of any
OpenNI2 camera or recording, in real time on a plain CPU, and shows, records,
compares and repairs skeletons."
  SUGGESTS "ossa-tools, ossa-readers, python3-ossa")
ossa_package(tools ossa-tools science "makes labelled depth images and body-part forests for ossa
The renderer of labelled images of people in motion, the trainer of forests
and of all else that ossa has learned, and the studies that compare methods."
  DEPENDS "ossa ${same}")
ossa_package(nite2 ossa-nite2 libs "NiTE 2's interface over ossa
libNiTE2.so for programs that were written against NiTE 2, and its headers:
NITE2_REDIST=/usr/lib/ossa/nite2."
  DEPENDS "ossa ${same}")
ossa_package(dev libossa-dev libdevel "headers of ossa, skeletons of people from depth images
Headers and CMake files for programs that follow people in depth images."
  DEPENDS "ossa ${same}, libeigen3-dev")
if(TARGET ossa_mkv_reader OR TARGET ossa_bag_reader OR TARGET ossa_rosbag2_reader OR TARGET ossa_array_reader)
  ossa_package(readers ossa-readers video "reads recordings of other depth cameras for ossa
Programs by which ossa reads recordings of the Azure Kinect and of Femto
(.mkv), of RealSense and of ROS 1 and 2 (.bag, .db3, .mcap), and arrays of NumPy,
MATLAB and HDF5 (.npy, .npz, .mat, .h5)."
    DEPENDS "ossa ${same}")
endif()
if(TARGET ossa_python)
  ossa_package(python3 python3-ossa python "skeletons of people from depth images, for Python
Depth images in, skeletons out, as NumPy arrays."
    DEPENDS "ossa ${same}, ossa-tools ${same}, python3 (>= ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}), python3 (<< ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}.999), python3-numpy")
endif()
include(CPack)
