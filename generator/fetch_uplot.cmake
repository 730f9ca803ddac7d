# Writes OUTPUT/uplot.js, OUTPUT/uplot.css and OUTPUT/LICENSE: uPlot of the version in the lock file of PACKAGE, which NPM installs in
# OUTPUT, or without npm CMake from the registry. The hash of the lock file holds for both. Without network the build fails: a
# program without plots is asked for by EDSC_PLOTS=OFF. Run with cmake -P.
cmake_policy(VERSION 3.25)
file(MAKE_DIRECTORY ${OUTPUT})

if(NOT PLOTS)
  file(WRITE ${OUTPUT}/uplot.js "")
  file(WRITE ${OUTPUT}/uplot.css "")
  return()
endif()

# What the lock file states: a version, and the SHA-512 of the archive in base64.
file(READ ${PACKAGE}/package-lock.json lock)
string(JSON version GET "${lock}" packages node_modules/uplot version)
string(JSON integrity GET "${lock}" packages node_modules/uplot integrity)

set(problems "")
if(NPM)
  file(COPY ${PACKAGE}/package.json ${PACKAGE}/package-lock.json DESTINATION ${OUTPUT})
  execute_process(
    COMMAND ${NPM} ci --ignore-scripts --no-audit --no-fund --fetch-retries=1
    WORKING_DIRECTORY ${OUTPUT}
    TIMEOUT 120
    RESULT_VARIABLE result
    OUTPUT_VARIABLE text
    ERROR_VARIABLE text)
  if(result EQUAL 0)
    set(dist ${OUTPUT}/node_modules/uplot/dist)
  else()
    string(APPEND problems "npm cannot install uPlot:\n${text}\n")
  endif()
endif()

# sha512_of_base64(TEXT RESULT): the digits of an integrity value, as CMake compares them.
function(sha512_of_base64 text result)
  string(REGEX REPLACE "^sha512-|=+$" "" text "${text}")
  set(alphabet ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/)
  set(digits 0123456789abcdef)
  set(hex "")
  set(bits 0)
  set(value 0)
  string(LENGTH "${text}" length)
  math(EXPR last "${length} - 1")
  foreach(at RANGE ${last})
    string(SUBSTRING "${text}" ${at} 1 character)
    string(FIND ${alphabet} "${character}" six)
    math(EXPR value "(${value} << 6) | ${six}")
    math(EXPR bits "${bits} + 6")
    while(bits GREATER_EQUAL 4)
      math(EXPR bits "${bits} - 4")
      math(EXPR digit "(${value} >> ${bits}) & 15")
      math(EXPR value "${value} & ((1 << ${bits}) - 1)")
      string(SUBSTRING ${digits} ${digit} 1 digit)
      string(APPEND hex ${digit})
    endwhile()
  endforeach()
  string(SUBSTRING ${hex} 0 128 hex)
  set(${result} ${hex} PARENT_SCOPE)
endfunction()

if(NOT dist)
  set(url https://registry.npmjs.org/uplot/-/uplot-${version}.tgz)
  set(archive ${OUTPUT}/uplot.tgz)
  sha512_of_base64("${integrity}" hash)
  file(DOWNLOAD ${url} ${archive} TIMEOUT 60 STATUS status)
  list(GET status 0 code)
  list(GET status 1 text)
  if(code EQUAL 0)
    file(SHA512 ${archive} found)
    if(NOT found STREQUAL hash)
      set(code 1)
      set(text "its SHA-512 is not that of ${PACKAGE}/package-lock.json")
    endif()
  endif()
  if(code EQUAL 0)
    file(ARCHIVE_EXTRACT INPUT ${archive} DESTINATION ${OUTPUT})
    set(dist ${OUTPUT}/package/dist)
  else()
    string(APPEND problems "cannot download ${url}: ${text}\n")
  endif()
endif()

if(NOT dist)
  message(FATAL_ERROR "${problems}edsc monitor --web draws its plots with uPlot. Build again with access to the npm registry, or "
                      "without these plots: -DEDSC_PLOTS=OFF")
endif()
configure_file(${dist}/uPlot.iife.min.js ${OUTPUT}/uplot.js COPYONLY)
configure_file(${dist}/uPlot.min.css ${OUTPUT}/uplot.css COPYONLY)
configure_file(${dist}/../LICENSE ${OUTPUT}/LICENSE COPYONLY)
