include(CMakePackageConfigHelpers)
configure_package_config_file(cmake/ossaConfig.cmake.in ossaConfig.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/ossa)
write_basic_package_version_file(ossaConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES cmake/FindOpenCVLite.cmake ${CMAKE_CURRENT_BINARY_DIR}/ossaConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/ossaConfigVersion.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/ossa COMPONENT dev)
install(EXPORT ossaTargets NAMESPACE ossa:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/ossa COMPONENT dev)

# For builds without CMake: `pkg-config --cflags --libs ossa`. Where its folder is moved, it says so. Static libraries
# would want all that they link, which ossaConfig.cmake alone finds.
if(BUILD_SHARED_LIBS)
  set(pkgconfig ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
  cmake_path(RELATIVE_PATH CMAKE_INSTALL_PREFIX BASE_DIRECTORY ${CMAKE_INSTALL_PREFIX}/${pkgconfig}
             OUTPUT_VARIABLE ossa_prefix_from_pkgconfig)
  configure_file(cmake/ossa.pc.in ossa.pc @ONLY)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/ossa.pc DESTINATION ${pkgconfig} COMPONENT dev)
endif()
