# The libraries of edsc for Windows: zlib of the cross compiler, and headers of the machine that builds. A cross compiler must not
# search all of that machine's headers, so a folder of the build has links to those of the libraries.

# Debian's package of pugixml has a library for Linux only. This is its source, which is compiled as headers.
set(EDSC_PUGIXML_ARCHIVE "http://deb.debian.org/debian/pool/main/p/pugixml/pugixml_1.13.orig.tar.gz"
    CACHE STRING "Source of pugixml for a program for Windows: URL or file")
set(pugixml_hash 5c5ad5d7caeb791420408042a7d88c2c6180781bf218feca259fd9d840a888e1)

set(EDSC_HOST_INCLUDE_DIR /usr/include CACHE PATH "Folder of the header-only libraries of the machine that builds")
set(linked_headers ${CMAKE_BINARY_DIR}/linked_headers)
file(MAKE_DIRECTORY ${linked_headers})
foreach(folder IN ITEMS CLI fmt kainjow nlohmann)
  if(NOT IS_DIRECTORY ${EDSC_HOST_INCLUDE_DIR}/${folder})
    message(FATAL_ERROR "missing headers ${EDSC_HOST_INCLUDE_DIR}/${folder}; packages.txt lists the packages")
  endif()
  file(CREATE_LINK ${EDSC_HOST_INCLUDE_DIR}/${folder} ${linked_headers}/${folder} SYMBOLIC)
endforeach()

# edsc_add_linked_library(NAME DEFINITION...) makes a target of a library in the folder of links.
function(edsc_add_linked_library name)
  add_library(${name} INTERFACE IMPORTED GLOBAL)
  target_include_directories(${name} SYSTEM INTERFACE ${linked_headers})
  target_compile_definitions(${name} INTERFACE ${ARGN})
endfunction()

# edsc_read_version(VARIABLE HEADER PATTERN...) reads the version of a library, as CMake packages state it: the numbers of one
# pattern after another.
function(edsc_read_version variable header)
  file(READ ${EDSC_HOST_INCLUDE_DIR}/${header} text)
  set(numbers "")
  foreach(pattern IN LISTS ARGN)
    if(NOT text MATCHES "${pattern}")
      message(FATAL_ERROR "${header} does not state its version")
    endif()
    list(APPEND numbers ${CMAKE_MATCH_1})
  endforeach()
  list(JOIN numbers . version)
  set(${variable} ${version} PARENT_SCOPE)
endfunction()

edsc_read_version(fmt_number fmt/core.h "FMT_VERSION ([0-9]+)")
math(EXPR fmt_major "${fmt_number} / 10000")
math(EXPR fmt_minor "${fmt_number} / 100 % 100")
math(EXPR fmt_patch "${fmt_number} % 100")
set(fmt_VERSION ${fmt_major}.${fmt_minor}.${fmt_patch})
edsc_read_version(CLI11_VERSION CLI/Version.hpp "CLI11_VERSION \"([0-9.]+)\"")
set(json_version "NLOHMANN_JSON_VERSION_")
edsc_read_version(nlohmann_json_VERSION nlohmann/detail/abi_macros.hpp "${json_version}MAJOR ([0-9]+)" "${json_version}MINOR ([0-9]+)"
                  "${json_version}PATCH ([0-9]+)")
string(REGEX MATCH "pugixml_([0-9.]+)\\.orig" pugixml_VERSION "${EDSC_PUGIXML_ARCHIVE}")
set(pugixml_VERSION ${CMAKE_MATCH_1})

edsc_add_linked_library(fmt::fmt-header-only FMT_HEADER_ONLY)
edsc_add_linked_library(nlohmann_json::nlohmann_json)
edsc_add_linked_library(CLI11::CLI11)
set(KAINJOW_MUSTACHE_INCLUDE_DIR ${linked_headers} CACHE PATH "Folder of kainjow/mustache.hpp")

include(FetchContent)
FetchContent_Declare(pugixml URL ${EDSC_PUGIXML_ARCHIVE} URL_HASH SHA256=${pugixml_hash} DOWNLOAD_EXTRACT_TIMESTAMP OFF
                                 SOURCE_SUBDIR none)
FetchContent_MakeAvailable(pugixml)
add_library(edsc_pugixml INTERFACE)
target_include_directories(edsc_pugixml SYSTEM INTERFACE ${pugixml_SOURCE_DIR}/src)
target_compile_definitions(edsc_pugixml INTERFACE PUGIXML_HEADER_ONLY)

find_package(ZLIB REQUIRED)
set(EDSC_FMT fmt::fmt-header-only)
set(EDSC_PUGIXML edsc_pugixml)
set(EDSC_ZLIB ZLIB::ZLIB)
