# cmake --install: library, headers, package files, programs and samples.
include(CMakePackageConfigHelpers)
install(TARGETS burnish EXPORT BurnishTargets LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY engine/include/burnish DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT BurnishTargets NAMESPACE Burnish:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Burnish)
configure_package_config_file(cmake/BurnishConfig.cmake.in ${PROJECT_BINARY_DIR}/BurnishConfig.cmake INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Burnish)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/BurnishConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/BurnishConfig.cmake ${PROJECT_BINARY_DIR}/BurnishConfigVersion.cmake DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Burnish)
