# Target rosbag: Debian's rosbag_storage, which reads ROS 1 bags without ROS. Its own CMake files want
# catkin and its pkg-config file a missing one, so that headers and libraries are found here.
# ROSBAG_LIBRARIES is empty where any is missing.
set(ROSBAG_LIBRARIES)
foreach(name rosbag_storage class_loader roslib roscpp_serialization rostime cpp_common console_bridge boost_filesystem)
  find_library(ROSBAG_${name}_LIBRARY ${name})
  list(APPEND ROSBAG_LIBRARIES ${ROSBAG_${name}_LIBRARY})
endforeach()
set(rosbag_headers
  rosbag/bag.h pluginlib/class_loader.hpp class_loader/class_loader.hpp
  rcutils/macros.h rcpputils/shared_library.hpp ament_index_cpp/get_resource.hpp)
set(ROSBAG_INCLUDES)
foreach(header ${rosbag_headers})
  cmake_path(GET header PARENT_PATH package)
  find_path(ROSBAG_${package}_INCLUDE ${header} PATH_SUFFIXES ${package})
  list(APPEND ROSBAG_INCLUDES ${ROSBAG_${package}_INCLUDE})
endforeach()
if("${ROSBAG_LIBRARIES};${ROSBAG_INCLUDES}" MATCHES "NOTFOUND")
  set(ROSBAG_LIBRARIES)
endif()
if(ROSBAG_LIBRARIES)
  list(REMOVE_DUPLICATES ROSBAG_INCLUDES)
  add_library(rosbag INTERFACE IMPORTED)
  target_link_libraries(rosbag INTERFACE ${ROSBAG_LIBRARIES})
  target_include_directories(rosbag SYSTEM INTERFACE ${ROSBAG_INCLUDES})
endif()
