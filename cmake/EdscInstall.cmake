include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/edsc)
install(TARGETS edsc_runtime EXPORT edscTargets)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/runtime/include/canopen DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
if(TARGET edsc)
  install(TARGETS edsc EXPORT edscTargets RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
install(EXPORT edscTargets NAMESPACE edsc:: DESTINATION ${package_dir})
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/edscConfigVersion.cmake COMPATIBILITY SameMinorVersion ARCH_INDEPENDENT)
install(FILES ${PROJECT_SOURCE_DIR}/cmake/edscConfig.cmake ${PROJECT_SOURCE_DIR}/cmake/EdscAddDictionary.cmake
              ${CMAKE_CURRENT_BINARY_DIR}/edscConfigVersion.cmake DESTINATION ${package_dir})
