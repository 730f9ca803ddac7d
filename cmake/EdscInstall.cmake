# The files of `cmake --install`, in two components: `program`, and `development` with the runtime's headers and the CMake
# package. The headers have a separate folder, so that a cross build that uses this folder does not find other host headers.
# The CMake package is the same on all machines and searches for the program of the machine that it is used on.
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_DATADIR}/cmake/edsc)
set(document_dir ${CMAKE_INSTALL_DATADIR}/doc)

if(TARGET edsc)
  install(TARGETS edsc RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
  if(NOT CMAKE_CROSSCOMPILING OR CMAKE_CROSSCOMPILING_EMULATOR) # edsc writes them itself
    set(shell_files ${PROJECT_BINARY_DIR}/generator/shell)
    install(FILES ${shell_files}/edsc.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME edsc
            COMPONENT program)
    install(FILES ${shell_files}/edsc.zsh DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions RENAME _edsc COMPONENT program)
    install(FILES ${shell_files}/edsc.man DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 RENAME edsc.1 COMPONENT program)
  endif()
  install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${document_dir}/edsc RENAME copyright COMPONENT program)
  # The documents for users and the files that they refer to, in the layout of the sources; the schemas also in a folder for
  # editors and scripts.
  install(FILES ${PROJECT_SOURCE_DIR}/README.md ${PROJECT_SOURCE_DIR}/CHANGELOG.md DESTINATION ${document_dir}/edsc
          COMPONENT program)
  install(FILES ${PROJECT_BINARY_DIR}/third_party/THIRD-PARTY-NOTICES ${PROJECT_BINARY_DIR}/third_party/edsc.cdx.json
          DESTINATION ${document_dir}/edsc COMPONENT program)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/examples ${PROJECT_SOURCE_DIR}/eds DESTINATION ${document_dir}/edsc COMPONENT program)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs DESTINATION ${document_dir}/edsc COMPONENT program
          PATTERN developers EXCLUDE PATTERN site EXCLUDE PATTERN make.py EXCLUDE PATTERN api.doxygen EXCLUDE)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs/schema DESTINATION ${CMAKE_INSTALL_DATADIR}/edsc COMPONENT program)
endif()

install(TARGETS edsc_runtime EXPORT edscTargets COMPONENT development)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/runtime/include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/edsc COMPONENT development)
install(EXPORT edscTargets NAMESPACE edsc:: DESTINATION ${package_dir} COMPONENT development)
set(generated_dir ${PROJECT_BINARY_DIR}/package)
configure_package_config_file(
  ${PROJECT_SOURCE_DIR}/cmake/edscConfig.cmake.in ${generated_dir}/edscConfig.cmake
  INSTALL_DESTINATION ${package_dir} PATH_VARS CMAKE_INSTALL_BINDIR)
write_basic_package_version_file(${generated_dir}/edscConfigVersion.cmake COMPATIBILITY SameMinorVersion ARCH_INDEPENDENT)
install(
  FILES ${generated_dir}/edscConfig.cmake ${generated_dir}/edscConfigVersion.cmake
        ${PROJECT_SOURCE_DIR}/cmake/EdscAddConformanceTest.cmake ${PROJECT_SOURCE_DIR}/cmake/EdscAddDictionary.cmake
        ${PROJECT_SOURCE_DIR}/cmake/EdscAddFirmware.cmake ${PROJECT_SOURCE_DIR}/cmake/EdscAddNetwork.cmake
        ${PROJECT_SOURCE_DIR}/cmake/EdscHeaders.cmake
        ${PROJECT_SOURCE_DIR}/cmake/firmware_bill.py ${PROJECT_SOURCE_DIR}/cmake/firmware_report.py
  DESTINATION ${package_dir} COMPONENT development)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/cmake/boards ${PROJECT_SOURCE_DIR}/cmake/toolchains DESTINATION ${package_dir}
        COMPONENT development
        PATTERN aarch64-linux-gnu.cmake EXCLUDE) # for edsc itself
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${document_dir}/libedsc-dev RENAME copyright COMPONENT development)
