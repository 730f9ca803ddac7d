cmake_policy(VERSION 3.25) # the depfile is read as CMake 3.20 and later do

# edsc_add_network(TARGET file)
#
# Adds the INTERFACE library TARGET, whose headers are generated at build time from a network file; the build fails where
# `edsc network check` finds an error. For plant.json:
#
#   edsc_add_network(line plant.json)
#   target_link_libraries(control PRIVATE line)        # #include <plant.hpp>
#
# The DCFs, concise DCFs, DBC file and drawings of the network are in the same folder, the property EDSC_FOLDER of the target.
#
# The files are generated again when the network file, an EDS, DCF or options file of a node, or edsc itself changes.
function(edsc_add_network target file)
  if(ARGN)
    message(FATAL_ERROR "edsc_add_network(${target}): unknown arguments: ${ARGN}")
  endif()
  get_filename_component(network ${file} ABSOLUTE)
  if(NOT EXISTS ${network})
    message(FATAL_ERROR "edsc_add_network(${target}): ${network} does not exist")
  endif()

  set(output_dir ${CMAKE_CURRENT_BINARY_DIR}/edsc/${target})
  set(stamp ${output_dir}.stamp)
  set(depfile ${output_dir}.d)
  # edsc does not write unchanged headers, to avoid needless recompilation; ninja compares the stamp. The names of the headers
  # depend on the contents of the network file. Each of them changes network-devices.hpp, which the header of the network
  # includes.
  add_custom_command(
    OUTPUT ${stamp}
    BYPRODUCTS ${output_dir}/network-devices.hpp
    COMMAND ${CMAKE_COMMAND} -E env --unset=EDSC_OVERLAYS $<TARGET_FILE:edsc::edsc> network generate ${network} -o
            ${output_dir} --force --depfile ${depfile} --depfile-target ${stamp}
    COMMAND ${CMAKE_COMMAND} -E touch ${stamp}
    DEPENDS ${network} edsc::edsc $<TARGET_FILE:edsc::edsc>
    DEPFILE ${depfile}
    COMMENT "Generating ${target} from ${file}"
    VERBATIM)
  add_custom_target(${target}_headers DEPENDS ${stamp})

  add_library(${target} INTERFACE)
  set_target_properties(${target} PROPERTIES EDSC_FOLDER ${output_dir})
  add_dependencies(${target} ${target}_headers)
  target_include_directories(${target} INTERFACE ${output_dir})
  target_link_libraries(${target} INTERFACE edsc::runtime)
endfunction()
