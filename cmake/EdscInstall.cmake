include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/edsc)
install(TARGETS edsc_runtime EXPORT edscTargets)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/runtime/include/canopen DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
if(TARGET edsc)
  install(TARGETS edsc EXPORT edscTargets RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  set(shell_files ${PROJECT_BINARY_DIR}/generator/shell)
  install(FILES ${shell_files}/edsc.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME edsc)
  install(FILES ${shell_files}/edsc.zsh DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions RENAME _edsc)
  install(FILES ${shell_files}/edsc.man DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 RENAME edsc.1)
endif()
install(EXPORT edscTargets NAMESPACE edsc:: DESTINATION ${package_dir})
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/edscConfigVersion.cmake COMPATIBILITY SameMinorVersion ARCH_INDEPENDENT)
install(FILES ${PROJECT_SOURCE_DIR}/cmake/edscConfig.cmake ${PROJECT_SOURCE_DIR}/cmake/EdscAddDictionary.cmake
              ${PROJECT_SOURCE_DIR}/cmake/EdscAddFirmware.cmake ${PROJECT_SOURCE_DIR}/cmake/firmware_report.py
              ${CMAKE_CURRENT_BINARY_DIR}/edscConfigVersion.cmake DESTINATION ${package_dir})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/cmake/boards DESTINATION ${package_dir})
