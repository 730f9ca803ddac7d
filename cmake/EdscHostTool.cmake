# Makes the imported or built target edsc::edsc: the compiler that runs on this machine.
#
# - EDSC_EXECUTABLE names one that is there already.
# - In a build for this machine it is built here.
# - In a cross build it is built for the host, in a build of its own.

if(TARGET edsc::edsc)
  return()
endif()

if(EDSC_EXECUTABLE)
  add_executable(edsc::edsc IMPORTED GLOBAL)
  set_target_properties(edsc::edsc PROPERTIES IMPORTED_LOCATION ${EDSC_EXECUTABLE})
  return()
endif()

include(ExternalProject)
set(host_build ${CMAKE_BINARY_DIR}/edsc-host)
ExternalProject_Add(
  edsc_host
  SOURCE_DIR ${CMAKE_CURRENT_LIST_DIR}/..
  BINARY_DIR ${host_build}
  CMAKE_ARGS -DCMAKE_BUILD_TYPE=Release -DEDSC_BUILD_TESTS=OFF -DEDSC_BUILD_EXAMPLES=OFF
  BUILD_COMMAND ${CMAKE_COMMAND} --build <BINARY_DIR> --target edsc
  INSTALL_COMMAND ""
  BUILD_ALWAYS ON
  BUILD_BYPRODUCTS ${host_build}/generator/edsc)
add_executable(edsc::edsc IMPORTED GLOBAL)
set_target_properties(edsc::edsc PROPERTIES IMPORTED_LOCATION ${host_build}/generator/edsc)
add_dependencies(edsc::edsc edsc_host)
