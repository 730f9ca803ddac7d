include(${CMAKE_CURRENT_LIST_DIR}/EdscAddDictionary.cmake)

# edsc_add_conformance_test(NAME DICTIONARY [COMPOSITION header type | APPLICATION header type] [NODE_ID n] [LEVEL level]
#                           [DEVIATIONS file] [ARGUMENTS argument...])
#
# Adds the test NAME to CTest: the conformance test of `edsc conform` on the device of DICTIONARY, a target of
# edsc_add_dictionary, in simulated time. The device is compiled as the program NAME, with the composition of the user's
# program; its storage, LSS port and memory of DOMAINs are in memory.
#
#   edsc_add_dictionary(pump EDS pump.eds)
#   enable_testing()
#   edsc_add_conformance_test(pump_conforms pump COMPOSITION pump.hpp PumpParts)
#
# COMPOSITION  a header and its canopen::Composition: the type that the program gives to canopen::Node or make_node
#              (canopen/node/composition.hpp). The report lists the parts that it omits.
# APPLICATION  a header and its application class (canopen_sim/simulated_device.hpp): short for a composition of the device
#              and this class. Without a type, edsc makes the composition: no application, all parts that the EDS promises.
#              Add sources and libraries that the header needs to the target NAME, with target_sources and
#              target_link_libraries.
# NODE_ID      node-ID of the device; default: that of the dictionary or of its DCF, else 5.
# LEVEL        read, communication, all (default: a simulated device cannot cause damage) or hostile.
# DEVIATIONS   a file that declares which cases deviate, and why.
# ARGUMENTS    further arguments of `edsc conform`, such as --junit, --only or --options.
#
# `ctest -L conformance` runs these tests. They are not added if BUILD_TESTING is off, nor in a cross build, whose devices are
# not compiled for the machine that runs edsc.
function(edsc_add_conformance_test name dictionary)
  cmake_parse_arguments(PARSE_ARGV 2 arg "" "NODE_ID;LEVEL;DEVIATIONS" "COMPOSITION;APPLICATION;ARGUMENTS")
  set(call "edsc_add_conformance_test(${name})")
  if(arg_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "${call}: unknown arguments: ${arg_UNPARSED_ARGUMENTS}")
  endif()
  if(NOT TARGET ${dictionary})
    message(FATAL_ERROR "${call}: there is no target ${dictionary}")
  endif()
  get_target_property(namespace ${dictionary} EDSC_NAMESPACE)
  get_target_property(sheet ${dictionary} EDSC_EDS)
  if(NOT namespace OR NOT sheet)
    message(FATAL_ERROR "${call}: ${dictionary} is not a library of edsc_add_dictionary")
  endif()
  if(CMAKE_CROSSCOMPILING OR (DEFINED BUILD_TESTING AND NOT BUILD_TESTING))
    message(VERBOSE "${call}: not added")
    return()
  endif()

  if(NOT arg_NODE_ID)
    get_target_property(arg_NODE_ID ${dictionary} EDSC_NODE_ID)
  endif()
  if(NOT arg_NODE_ID)
    edsc_node_id_of_file(${sheet} arg_NODE_ID)
  endif()
  if(NOT arg_NODE_ID)
    set(arg_NODE_ID 5)
  endif()
  math(EXPR node_id "${arg_NODE_ID}")
  if(node_id LESS 1 OR node_id GREATER 127)
    message(FATAL_ERROR "${call}: ${arg_NODE_ID} is not a node-ID from 1 to 127")
  endif()

  set(include "")
  set(parts "${namespace}::Device")
  if(DEFINED arg_COMPOSITION AND DEFINED arg_APPLICATION)
    message(FATAL_ERROR "${call}: COMPOSITION and APPLICATION: expected one of them")
  endif()
  foreach(keyword IN ITEMS COMPOSITION APPLICATION)
    if(DEFINED arg_${keyword})
      list(LENGTH arg_${keyword} count)
      if(NOT count EQUAL 2)
        message(FATAL_ERROR "${call}: ${keyword} takes a header and a type, not: ${arg_${keyword}}")
      endif()
      list(GET arg_${keyword} 0 header)
      list(GET arg_${keyword} 1 type)
      cmake_path(ABSOLUTE_PATH header BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR})
      if(NOT EXISTS ${header})
        message(FATAL_ERROR "${call}: ${header} does not exist")
      endif()
      set(include "#include \"${header}\"\n")
      if(keyword STREQUAL "COMPOSITION")
        set(parts "${type}")
        string(APPEND include "\nstatic_assert(canopen::is_composition_of<${type}, ${namespace}::Device>,\n"
                              "              \"COMPOSITION: expected a canopen::Composition of ${namespace}::Device\");\n")
      else()
        string(APPEND parts ", ${type}")
      endif()
    endif()
  endforeach()
  set(source ${CMAKE_CURRENT_BINARY_DIR}/edsc/${name}.cpp)
  file(CONFIGURE OUTPUT ${source} @ONLY CONTENT [[
// Made by edsc_add_conformance_test.
#include <@namespace@/device.hpp>
#include <canopen_sim/simulated_device.hpp>
@include@
int main(int argc, char** argv) { return canopen::simulate_device<@parts@>(argc, argv); }
]])
  add_executable(${name} ${source})
  target_link_libraries(${name} PRIVATE ${dictionary})

  if(NOT arg_LEVEL)
    set(arg_LEVEL all)
  endif()
  set(arguments --level ${arg_LEVEL})
  if(arg_LEVEL MATCHES "^(all|hostile)$")
    list(APPEND arguments --store --application --outputs)
  endif()
  if(arg_DEVIATIONS)
    cmake_path(ABSOLUTE_PATH arg_DEVIATIONS BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} OUTPUT_VARIABLE deviations)
    if(NOT EXISTS ${deviations})
      message(FATAL_ERROR "${call}: ${deviations} does not exist")
    endif()
    list(APPEND arguments --deviations ${deviations})
  endif()
  add_test(NAME ${name} COMMAND $<TARGET_FILE:edsc::edsc> conform "simulated:$<TARGET_FILE:${name}>@${node_id}" ${node_id}
                                ${sheet} ${arguments} ${arg_ARGUMENTS})
  set_tests_properties(${name} PROPERTIES LABELS conformance ENVIRONMENT_MODIFICATION EDSC_OVERLAYS=unset:)
endfunction()

# Returns the node-ID of a DCF or XDC, or of an overlay and its bases; empty if the file does not have one.
function(edsc_node_id_of_file file result)
  set(number "(0[xX][0-9A-Fa-f]+|[0-9]+)")
  set(node_id "")
  file(READ ${file} text)
  if(text MATCHES "(^|\n)[ \t]*[Nn][Oo][Dd][Ee][Ii][Dd][ \t]*=([^\n]*=>)?[ \t]*${number}[ \t\r]*(\n|;|$)")
    set(node_id ${CMAKE_MATCH_3})
  elseif(text MATCHES "<([A-Za-z]+:)?deviceCommissioning[^>]*[ \t\r\n]nodeID=\"${number}\"")
    set(node_id ${CMAKE_MATCH_2})
  elseif(file MATCHES "\\.overlay$" AND text MATCHES "\n[ \t]*[Bb][Aa][Ss][Ee][ \t]*=[ \t]*([^\r\n]*[^ \t\r\n])")
    cmake_path(GET file PARENT_PATH folder)
    cmake_path(ABSOLUTE_PATH CMAKE_MATCH_1 BASE_DIRECTORY ${folder} OUTPUT_VARIABLE base)
    if(EXISTS ${base})
      edsc_node_id_of_file(${base} node_id)
    endif()
  endif()
  set(${result} ${node_id} PARENT_SCOPE)
endfunction()
