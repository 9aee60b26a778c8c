include(CMakePackageConfigHelpers)
configure_package_config_file(cmake/ossaConfig.cmake.in ossaConfig.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/ossa)
write_basic_package_version_file(ossaConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES cmake/FindOpenCVLite.cmake ${CMAKE_CURRENT_BINARY_DIR}/ossaConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/ossaConfigVersion.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/ossa COMPONENT dev)
install(EXPORT ossaTargets NAMESPACE ossa:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/ossa COMPONENT dev)
