# The libraries in the program edsc: one table, from which the build writes THIRD-PARTY-NOTICES with their licenses, and
# edsc.cdx.json, a bill of materials in CycloneDX 1.5, in the folder third_party. Both are installed with the documents.
if(NOT WIN32)
  find_package(CLI11 QUIET REQUIRED)
  find_package(nlohmann_json QUIET REQUIRED)
endif()

# edsc_third_party(NAME VERSION version LICENSE expression PURL type/name URL url LINKED header|library|file
#                  [DEBIAN package | TEXT file] [LICENSES name...])
#
# LICENSE   SPDX expression.
# PURL      without the version: https://github.com/package-url/purl-spec
# LINKED    header and file: its code is in each program. library: only in a static program.
# DEBIAN    package whose file `copyright` has the copyright notices and licenses; TEXT is another file that has them.
# LICENSES  files of /usr/share/common-licenses to which the text refers.
function(edsc_third_party name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "VERSION;LICENSE;PURL;URL;LINKED;DEBIAN;TEXT" "LICENSES")
  if(arg_LINKED STREQUAL "library" AND NOT EDSC_STATIC)
    set(inside "no, a shared library")
  else()
    set(inside yes)
  endif()
  set(text "${arg_TEXT}")
  if(arg_DEBIAN)
    set(text ${EDSC_DEBIAN_ROOT}/usr/share/doc/${arg_DEBIAN}/copyright)
    if(NOT EXISTS ${text})
      set(text /usr/share/doc/${arg_DEBIAN}/copyright)
    endif()
  endif()
  list(JOIN arg_LICENSES "," licenses)
  set_property(GLOBAL APPEND PROPERTY edsc_third_party_rows
               "${name}|${arg_VERSION}|${arg_LICENSE}|${arg_PURL}|${arg_URL}|${inside}|${text}|${licenses}")
endfunction()

edsc_third_party(fmt VERSION ${fmt_VERSION} LICENSE MIT PURL github/fmtlib/fmt URL https://fmt.dev LINKED library
                 DEBIAN libfmt-dev)
edsc_third_party("JSON for Modern C++" VERSION ${nlohmann_json_VERSION} LICENSE MIT PURL github/nlohmann/json
                 URL https://json.nlohmann.me LINKED header DEBIAN nlohmann-json3-dev)
edsc_third_party(Mustache VERSION 4.1 LICENSE BSL-1.0 PURL github/kainjow/mustache URL https://github.com/kainjow/Mustache
                 LINKED header DEBIAN libkainjow-mustache-dev)
edsc_third_party(CLI11 VERSION ${CLI11_VERSION} LICENSE BSD-3-Clause PURL github/CLIUtils/CLI11
                 URL https://github.com/CLIUtils/CLI11 LINKED header DEBIAN libcli11-dev)
edsc_third_party(pugixml VERSION ${pugixml_VERSION} LICENSE MIT PURL github/zeux/pugixml URL https://pugixml.org
                 LINKED library DEBIAN libpugixml-dev)
edsc_third_party(zlib VERSION ${ZLIB_VERSION_STRING} LICENSE Zlib PURL github/madler/zlib URL https://zlib.net LINKED library
                 DEBIAN zlib1g-dev)
if(NOT EDSC_OFFLINE)
  edsc_third_party(Nettle VERSION ${EDSC_NETTLE_VERSION} LICENSE "LGPL-3.0-or-later OR GPL-2.0-or-later"
                   PURL generic/nettle URL https://www.lysator.liu.se/~nisse/nettle LINKED library DEBIAN nettle-dev
                   LICENSES LGPL-3 GPL-3 GPL-2)
  if(EDSC_STATIC)
    set(httplib_text TEXT ${httplib_SOURCE_DIR}/LICENSE)
  else()
    set(httplib_text DEBIAN libcpp-httplib-dev)
  endif()
  edsc_third_party(cpp-httplib VERSION ${EDSC_HTTPLIB_VERSION} LICENSE MIT PURL github/yhirose/cpp-httplib
                   URL https://github.com/yhirose/cpp-httplib LINKED library ${httplib_text})
  if(EDSC_PLOTS)
    file(READ ${PROJECT_SOURCE_DIR}/templates/monitor/uplot/package-lock.json lock)
    string(JSON uplot_version GET "${lock}" packages node_modules/uplot version)
    edsc_third_party(uPlot VERSION ${uplot_version} LICENSE MIT PURL npm/uplot URL https://github.com/leeoniya/uPlot
                     LINKED file TEXT ${EDSC_UPLOT_DIR}/LICENSE)
  endif()
endif()
if(EDSC_STATIC AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND NOT WIN32)
  set(cross "")
  if(CMAKE_CROSSCOMPILING AND CMAKE_LIBRARY_ARCHITECTURE STREQUAL "aarch64-linux-gnu")
    set(cross -arm64-cross)
  endif()
  string(REGEX MATCH "^[0-9]+" gcc "${CMAKE_CXX_COMPILER_VERSION}")
  edsc_third_party("libstdc++ and libgcc" VERSION ${CMAKE_CXX_COMPILER_VERSION}
                   LICENSE "GPL-3.0-or-later WITH GCC-exception-3.1" PURL generic/gcc URL https://gcc.gnu.org LINKED library
                   DEBIAN libstdc++-${gcc}-dev${cross} LICENSES GPL-3)
  execute_process(COMMAND ${CMAKE_CXX_COMPILER} -E -dM -include features.h -x c++ /dev/null OUTPUT_VARIABLE macros
                          COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX MATCH "__GLIBC__ ([0-9]+)" major "${macros}")
  set(glibc ${CMAKE_MATCH_1})
  string(REGEX MATCH "__GLIBC_MINOR__ ([0-9]+)" minor "${macros}")
  edsc_third_party("GNU C Library" VERSION ${glibc}.${CMAKE_MATCH_1} LICENSE LGPL-2.1-or-later PURL generic/glibc
                   URL https://www.gnu.org/software/libc LINKED library DEBIAN libc6-dev${cross} LICENSES LGPL-2.1)
endif()

if(WIN32)
  edsc_third_party("libstdc++, libgcc and libssp" VERSION ${CMAKE_CXX_COMPILER_VERSION}
                   LICENSE "GPL-3.0-or-later WITH GCC-exception-3.1" PURL generic/gcc URL https://gcc.gnu.org LINKED library
                   DEBIAN gcc-mingw-w64-base LICENSES GPL-3)
  execute_process(COMMAND ${CMAKE_CXX_COMPILER} -E -dM -include _mingw.h -x c++ /dev/null OUTPUT_VARIABLE macros
                          COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX MATCH "__MINGW64_VERSION_MAJOR ([0-9]+)" major "${macros}")
  set(mingw ${CMAKE_MATCH_1})
  string(REGEX MATCH "__MINGW64_VERSION_MINOR ([0-9]+)" minor "${macros}")
  edsc_third_party("MinGW-w64 runtime and winpthreads" VERSION ${mingw}.${CMAKE_MATCH_1} LICENSE "ZPL-2.1 AND MIT"
                   PURL generic/mingw-w64 URL https://www.mingw-w64.org LINKED library DEBIAN mingw-w64-x86-64-dev)
endif()

set(third_party_dir ${PROJECT_BINARY_DIR}/third_party)
get_property(third_party_rows GLOBAL PROPERTY edsc_third_party_rows)
list(JOIN third_party_rows "\n" third_party_lines)
file(CONFIGURE OUTPUT ${third_party_dir}/rows CONTENT "${third_party_lines}\n" @ONLY)
set(third_party_inputs "")
foreach(row IN LISTS third_party_rows)
  string(REPLACE "|" ";" row "${row}")
  list(GET row 6 text)
  list(APPEND third_party_inputs ${text})
endforeach()
list(FILTER third_party_inputs EXCLUDE REGEX "^/usr/")
add_custom_command(
  OUTPUT ${third_party_dir}/THIRD-PARTY-NOTICES ${third_party_dir}/edsc.cdx.json
  COMMAND ${CMAKE_COMMAND} -DROWS=${third_party_dir}/rows -DVERSION=${PROJECT_VERSION} -DOUTPUT=${third_party_dir} -P
          ${PROJECT_SOURCE_DIR}/cmake/write_third_party.cmake
  DEPENDS ${third_party_dir}/rows ${PROJECT_SOURCE_DIR}/cmake/write_third_party.cmake ${third_party_inputs}
  COMMENT "Writing the notices and the bill of materials"
  VERBATIM)
add_custom_target(edsc_third_party DEPENDS ${third_party_dir}/THIRD-PARTY-NOTICES)
add_dependencies(edsc edsc_third_party)
