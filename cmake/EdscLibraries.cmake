# The libraries of the program edsc, by one name each: EDSC_FMT, EDSC_PUGIXML, EDSC_ZLIB, EDSC_NETTLE and EDSC_HTTPLIB. With
# EDSC_STATIC they are part of the program, which then needs no library of the machine.

# The shared cpp-httplib of Debian brings OpenSSL and brotli. This is its source, without both.
set(EDSC_HTTPLIB_ARCHIVE "http://deb.debian.org/debian/pool/main/c/cpp-httplib/cpp-httplib_0.11.4+ds.orig.tar.xz"
    CACHE STRING "Source of cpp-httplib for a static program: URL or file")
set(httplib_hash 8b1a5df569003b6a4f24c68489bbda5c64aec94697bdc9ebba5d79408b2ae7eb)

# The libraries for another processor: packages.txt names them. cpp-httplib is the source above.
set(EDSC_DEBIAN_ARCHITECTURE ""
    CACHE STRING "Architecture, such as arm64, for which the libraries are fetched from Debian; empty: they are installed")
if(EDSC_DEBIAN_ARCHITECTURE)
  set(EDSC_DEBIAN_ROOT ${PROJECT_BINARY_DIR}/debian-${EDSC_DEBIAN_ARCHITECTURE})
  if(NOT EXISTS ${EDSC_DEBIAN_ROOT}/versions)
    file(STRINGS ${PROJECT_SOURCE_DIR}/packages.txt libraries REGEX "^build +.*-dev$")
    list(TRANSFORM libraries REPLACE "^build +" "")
    list(REMOVE_ITEM libraries libcpp-httplib-dev)
    message(STATUS "Fetching the libraries for ${EDSC_DEBIAN_ARCHITECTURE}")
    execute_process(COMMAND ${PROJECT_SOURCE_DIR}/cmake/fetch_debian_libraries.sh ${EDSC_DEBIAN_ARCHITECTURE}
                            ${EDSC_DEBIAN_ROOT} ${libraries} COMMAND_ERROR_IS_FATAL ANY)
  endif()
  list(APPEND CMAKE_FIND_ROOT_PATH ${EDSC_DEBIAN_ROOT})
endif()

if(EDSC_STATIC)
  set(CMAKE_FIND_LIBRARY_SUFFIXES .a)
endif()
if(WIN32)
  include(${CMAKE_CURRENT_LIST_DIR}/EdscWindowsLibraries.cmake)
  return()
endif()
find_package(fmt REQUIRED)
find_package(pugixml REQUIRED)
find_package(ZLIB REQUIRED)
set(EDSC_FMT fmt::fmt)
set(EDSC_PUGIXML pugixml::pugixml)
set(EDSC_ZLIB ZLIB::ZLIB)
if(EDSC_STATIC)
  set(EDSC_FMT fmt::fmt-header-only) # Debian has no static one
  set(EDSC_PUGIXML pugixml::static)
endif()

# edsc_version_in(FILE EXPRESSION VARIABLE): the version of a library without a package for CMake; empty without the file.
function(edsc_version_in file expression variable)
  set(${variable} "" PARENT_SCOPE)
  if(EXISTS ${file})
    file(STRINGS ${file} line REGEX "${expression}" LIMIT_COUNT 1)
    if(line MATCHES "${expression}")
      set(${variable} ${CMAKE_MATCH_1} PARENT_SCOPE)
    endif()
  endif()
endfunction()

if(NOT EDSC_OFFLINE)
  find_path(NETTLE_INCLUDE_DIR nettle/sha2.h REQUIRED)
  find_library(NETTLE_LIBRARY nettle REQUIRED)
  add_library(edsc_nettle INTERFACE)
  target_include_directories(edsc_nettle SYSTEM INTERFACE ${NETTLE_INCLUDE_DIR})
  target_link_libraries(edsc_nettle INTERFACE ${NETTLE_LIBRARY})
  set(EDSC_NETTLE edsc_nettle)
  cmake_path(GET NETTLE_LIBRARY PARENT_PATH nettle_folder)
  edsc_version_in(${nettle_folder}/pkgconfig/nettle.pc "^Version: *([0-9.]+)" EDSC_NETTLE_VERSION)
  if(EDSC_STATIC)
    include(FetchContent)
    FetchContent_Declare(httplib URL ${EDSC_HTTPLIB_ARCHIVE} URL_HASH SHA256=${httplib_hash} DOWNLOAD_EXTRACT_TIMESTAMP OFF
                                     SOURCE_SUBDIR none)
    FetchContent_MakeAvailable(httplib)
    add_library(edsc_httplib INTERFACE)
    target_include_directories(edsc_httplib SYSTEM INTERFACE ${httplib_SOURCE_DIR})
    set(EDSC_HTTPLIB edsc_httplib)
    edsc_version_in(${httplib_SOURCE_DIR}/httplib.h "CPPHTTPLIB_VERSION \"([0-9.]+)" EDSC_HTTPLIB_VERSION)
  else()
    find_package(PkgConfig REQUIRED)
    pkg_check_modules(HTTPLIB REQUIRED IMPORTED_TARGET cpp-httplib)
    set(EDSC_HTTPLIB PkgConfig::HTTPLIB)
    set(EDSC_HTTPLIB_VERSION ${HTTPLIB_VERSION})
  endif()
endif()
