cmake_policy(VERSION 3.25) # the depfile is read as CMake 3.20 and later do

# edsc_add_dictionary(TARGET EDS file [NAMESPACE name] [NODE_ID n] [OPTIONS file] [STATIC_MAPPING] [KEEP_GOING])
#
# Adds the INTERFACE library TARGET, whose headers are generated at build time from an EDS or DCF, or an overlay of one:
#
#   edsc_add_dictionary(cpc_tc1 EDS eds/cpc-tc1.eds)
#   target_link_libraries(drive PRIVATE cpc_tc1)        # #include <cpc_tc1/device.hpp>
#
# NAMESPACE      C++ namespace and include folder; default: TARGET.
# NODE_ID        resolves $NODEID formulas.
# OPTIONS        options file; default: NAME.options.json beside the EDS, if it exists.
# STATIC_MAPPING makes all mapping parameters constant: PDOs cannot be mapped over the bus, and the image is smaller.
# KEEP_GOING     for the file of a purchased device, which you cannot change: its errors are warnings, and invalid items are
#                omitted and reported (edsc generate --keep-going).
#
# The headers are regenerated when the EDS, the bases of an overlay, the options file, a template or edsc itself changes.
# The environment variable EDSC_OVERLAYS is not used.
function(edsc_add_dictionary target)
  cmake_parse_arguments(PARSE_ARGV 1 arg "STATIC_MAPPING;KEEP_GOING" "EDS;NAMESPACE;NODE_ID;OPTIONS" "")
  if(arg_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "edsc_add_dictionary(${target}): unknown arguments: ${arg_UNPARSED_ARGUMENTS}")
  endif()
  if(NOT arg_EDS)
    message(FATAL_ERROR "edsc_add_dictionary(${target}): EDS is missing")
  endif()
  if(NOT arg_NAMESPACE)
    set(arg_NAMESPACE ${target})
  endif()
  get_filename_component(eds ${arg_EDS} ABSOLUTE)
  if(NOT EXISTS ${eds})
    message(FATAL_ERROR "edsc_add_dictionary(${target}): ${eds} does not exist")
  endif()

  set(output_dir ${CMAKE_CURRENT_BINARY_DIR}/edsc/${target})
  set(depfile ${output_dir}/${arg_NAMESPACE}.d)
  include(${CMAKE_CURRENT_FUNCTION_LIST_DIR}/EdscHeaders.cmake)
  list(TRANSFORM EDSC_HEADERS PREPEND ${output_dir}/${arg_NAMESPACE}/ OUTPUT_VARIABLE headers)

  set(stamp ${output_dir}/${arg_NAMESPACE}.stamp)
  set(arguments ${eds} -o ${output_dir} --name ${arg_NAMESPACE} --depfile ${depfile} --depfile-target ${stamp})
  if(arg_NODE_ID)
    list(APPEND arguments --node-id ${arg_NODE_ID})
  endif()
  if(arg_STATIC_MAPPING)
    list(APPEND arguments --static-mapping)
  endif()
  if(arg_KEEP_GOING)
    list(APPEND arguments --keep-going)
  endif()
  set(dependencies ${eds})
  if(arg_OPTIONS)
    get_filename_component(options ${arg_OPTIONS} ABSOLUTE)
    list(APPEND arguments --options ${options})
    list(APPEND dependencies ${options})
  else()
    # A new options file is detected at the next configure; an existing one is in the depfile.
    string(REGEX REPLACE "\\.[^.]*$" ".options.json" options ${eds})
    if(EXISTS ${options})
      list(APPEND dependencies ${options})
    endif()
  endif()

  set(generator edsc::edsc)
  if(TARGET edsc_generator)
    set(generator edsc_generator)
  endif()
  # edsc does not write unchanged headers, to avoid needless recompilation; ninja compares the stamp.
  add_custom_command(
    OUTPUT ${stamp}
    BYPRODUCTS ${headers}
    COMMAND ${CMAKE_COMMAND} -E env --unset=EDSC_OVERLAYS $<TARGET_FILE:${generator}> generate ${arguments}
    COMMAND ${CMAKE_COMMAND} -E touch ${stamp}
    DEPENDS ${dependencies} ${generator} $<TARGET_FILE:${generator}>
    DEPFILE ${depfile}
    COMMENT "Generating ${arg_NAMESPACE} from ${arg_EDS}"
    VERBATIM)
  add_custom_target(${target}_headers DEPENDS ${stamp})

  add_library(${target} INTERFACE)
  # For edsc_add_conformance_test.
  set_target_properties(${target} PROPERTIES EDSC_NAMESPACE ${arg_NAMESPACE} EDSC_EDS ${eds} EDSC_NODE_ID "${arg_NODE_ID}")
  add_dependencies(${target} ${target}_headers)
  target_include_directories(${target} INTERFACE ${output_dir})
  # Clang evaluates a million steps of a constant, which a node with thousands of mapped objects exceeds.
  target_compile_options(${target} INTERFACE $<$<COMPILE_LANG_AND_ID:CXX,Clang,AppleClang>:-fconstexpr-steps=100000000>)
  target_link_libraries(${target} INTERFACE edsc::runtime)
endfunction()
