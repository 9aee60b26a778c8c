# `cmake --build BUILD --target package` makes a Debian package, ossa_VERSION_amd64.deb: the command,
# the libraries with their headers and CMake files, the OpenNI2 drivers, udev rules and shipped models.
# What it depends on is read from the binaries. The programs that read .mkv and .bag are a package of
# their own, ossa-readers_VERSION_amd64.deb: their libraries are larger than all the rest.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME ossa)
set(CPACK_PACKAGE_VENDOR "the ossa authors")
set(CPACK_PACKAGE_CONTACT "the ossa authors <ossa@localhost>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_LIBRARY_OUTPUT_DIRECTORY})
# Only who compiles against the headers needs Eigen.
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "libeigen3-dev")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "skeletons of people from depth images")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION
"Tracks the 20 Kinect SDK joints of up to six people in depth images of any
OpenNI2 camera or recording, in real time on a plain CPU. With the trainer of
its body-part forest and tools to compare and repair recorded skeletons.")
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_COMPONENTS_ALL Unspecified readers)
set(CPACK_DEBIAN_UNSPECIFIED_PACKAGE_NAME ossa)
set(CPACK_DEBIAN_UNSPECIFIED_PACKAGE_RECOMMENDS ossa-readers)
set(CPACK_DEBIAN_READERS_PACKAGE_NAME ossa-readers)
set(CPACK_DEBIAN_READERS_PACKAGE_DEPENDS "ossa (= ${PROJECT_VERSION})")
set(CPACK_DEBIAN_READERS_DESCRIPTION
"Programs by which ossa reads recordings of the Azure Kinect and of Femto (.mkv)
and ROS 1 bags (.bag).")
include(CPack)
