# The Debian packages, made by the target `package` or cpack: edsc_VERSION_ARCHITECTURE.deb with the program, and
# libedsc-dev_VERSION_all.deb with the files to compile a device. For a static program also an archive of the whole for any
# Linux, edsc-VERSION-linux-PROCESSOR.tar.gz. Packages of a commit have the same bytes everywhere.
set(CPACK_GENERATOR DEB)
if(EDSC_STATIC AND NOT WIN32)
  list(APPEND CPACK_GENERATOR TGZ)
  set(CPACK_PACKAGE_FILE_NAME edsc-${PROJECT_VERSION}-linux-${CMAKE_SYSTEM_PROCESSOR})
endif()
set(CPACK_PACKAGE_NAME edsc)
# Debian requires name and address of a maintainer: `-DEDSC_MAINTAINER="Name <address>"`. No mail reaches the default address,
# whose domain is reserved for that (RFC 2606).
set(EDSC_MAINTAINER "edsc maintainers <maintainers@edsc.invalid>" CACHE STRING "Maintainer of the Debian packages")
set(CPACK_PACKAGE_CONTACT "${EDSC_MAINTAINER}")
set(CPACK_COMPONENTS_ALL program development)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ
                                                WORLD_EXECUTE)
set(CPACK_EDSC_SOURCE_DIR ${PROJECT_SOURCE_DIR})
set(CPACK_PROJECT_CONFIG_FILE ${PROJECT_SOURCE_DIR}/cmake/package_date.cmake)
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/compress_manual_pages.cmake
                            ${PROJECT_SOURCE_DIR}/cmake/package_times.cmake)
set(CPACK_POST_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/package_order.cmake)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME edsc)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION devel)
if(EDSC_STATIC)
  set(CPACK_DEBIAN_PACKAGE_ARCHITECTURE ${EDSC_DEBIAN_ARCHITECTURE}) # empty: that of dpkg
else()
  set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON) # needs dpkg-shlibdeps (package dpkg-dev) and file
endif()
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS libedsc-dev)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "") # CPack would prepend it to each description
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "${PROJECT_DESCRIPTION}
It generates checked C++20 from EDS, DCF and XDD files: a constexpr object
dictionary, typed access to every object and PDO codecs. Its other commands
check, format and compare these files, decode CAN logs, and scan, read,
configure and monitor the devices of a live bus.")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libedsc-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "edsc (= ${PROJECT_VERSION})")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_RECOMMENDS "cmake (>= 3.25), g++, ninja-build, python3 (>= 3.11)")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SUGGESTS "gcc-arm-none-eabi, libstdc++-arm-none-eabi-newlib")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "${PROJECT_DESCRIPTION}, development files
Files needed to compile a device: headers of the CANopen runtime, which needs
no heap, no exceptions and no operating system, functions for CMake, and
start-up code, linker scripts and drivers of boards with a Cortex-M.")

# For Windows an archive without an installer: `cpack -G ZIP`. The program finds the documents beside it.
if(WIN32)
  install(TARGETS edsc RUNTIME DESTINATION . COMPONENT windows EXCLUDE_FROM_ALL)
  install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/README.md ${PROJECT_SOURCE_DIR}/CHANGELOG.md DESTINATION .
          COMPONENT windows EXCLUDE_FROM_ALL)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs ${PROJECT_SOURCE_DIR}/eds ${PROJECT_SOURCE_DIR}/examples DESTINATION .
          COMPONENT windows EXCLUDE_FROM_ALL
          PATTERN developers EXCLUDE PATTERN site EXCLUDE PATTERN make.py EXCLUDE PATTERN api.doxygen EXCLUDE)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/runtime/include/ DESTINATION include/edsc COMPONENT windows EXCLUDE_FROM_ALL)
  set(CPACK_GENERATOR ZIP)
  set(CPACK_PACKAGE_FILE_NAME edsc-${PROJECT_VERSION}-windows-x86_64)
  set(CPACK_PACKAGING_INSTALL_PREFIX "")
  set(CPACK_COMPONENTS_ALL windows)
  set(CPACK_ARCHIVE_COMPONENT_INSTALL ON)
  set(CPACK_COMPONENTS_GROUPING ALL_COMPONENTS_IN_ONE)
  set(CPACK_COMPONENT_INCLUDE_TOPLEVEL_DIRECTORY ON)
endif()

include(CPack)
