# Provides the imported or built target edsc::edsc: the program edsc for this machine.
#
# - EDSC_EXECUTABLE names an existing program; a project that contains edsc then does not compile it.
# - EDSC_HOST_PRESET names a preset of this project whose build has the program; that build is brought up to date.
# - In a build for this machine, the program is built here.
# - In a cross build, the program is built for the host, in a separate build with EDSC_HOST_ARGUMENTS as further arguments.

if(TARGET edsc::edsc)
  return()
endif()

if(EDSC_EXECUTABLE)
  add_executable(edsc::edsc IMPORTED GLOBAL)
  set_target_properties(edsc::edsc PROPERTIES IMPORTED_LOCATION ${EDSC_EXECUTABLE})
  return()
endif()

if(EDSC_HOST_PRESET)
  set(executable ${PROJECT_SOURCE_DIR}/build/${EDSC_HOST_PRESET}/generator/edsc)
  add_custom_target(
    edsc_host
    COMMAND ${CMAKE_COMMAND} --preset ${EDSC_HOST_PRESET} --log-level=WARNING
    COMMAND ${CMAKE_COMMAND} --build --preset ${EDSC_HOST_PRESET} --target edsc
    BYPRODUCTS ${executable}
    WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}
    COMMENT "Building edsc by the preset ${EDSC_HOST_PRESET}"
    VERBATIM)
  add_executable(edsc::edsc IMPORTED GLOBAL)
  set_target_properties(edsc::edsc PROPERTIES IMPORTED_LOCATION ${executable})
  add_dependencies(edsc::edsc edsc_host)
  return()
endif()

include(ExternalProject)
set(EDSC_HOST_ARGUMENTS "" CACHE STRING "further arguments of cmake when edsc is built for the host of a cross build")
set(host_build ${CMAKE_BINARY_DIR}/edsc-host)
set(host_program ${host_build}/program/edsc)
# These environment variables are for the target's compiler.
set(host_cmake ${CMAKE_COMMAND} -E env)
foreach(variable IN ITEMS CMAKE_TOOLCHAIN_FILE CC CXX CPPFLAGS CFLAGS CXXFLAGS LDFLAGS)
  list(APPEND host_cmake --unset=${variable})
endforeach()
list(APPEND host_cmake ${CMAKE_COMMAND})
ExternalProject_Add(
  edsc_host
  SOURCE_DIR ${PROJECT_SOURCE_DIR}
  BINARY_DIR ${host_build}
  CONFIGURE_COMMAND
    ${host_cmake} -S <SOURCE_DIR> -B <BINARY_DIR> -G ${CMAKE_GENERATOR} -DCMAKE_BUILD_TYPE=Release
    -DEDSC_BUILD_TESTS=OFF -DEDSC_BUILD_EXAMPLES=OFF -DCMAKE_RUNTIME_OUTPUT_DIRECTORY_RELEASE=${host_build}/program
    ${EDSC_HOST_ARGUMENTS}
  BUILD_COMMAND ${host_cmake} --build <BINARY_DIR> --config Release --target edsc
  INSTALL_COMMAND ""
  BUILD_BYPRODUCTS ${host_program}
  USES_TERMINAL_BUILD ON)
# The host build runs only after one of its files has changed.
file(GLOB_RECURSE host_files ${PROJECT_SOURCE_DIR}/generator/* ${PROJECT_SOURCE_DIR}/bus/* ${PROJECT_SOURCE_DIR}/cli/*
     ${PROJECT_SOURCE_DIR}/templates/* ${PROJECT_SOURCE_DIR}/runtime/*)
ExternalProject_Add_StepDependencies(edsc_host build ${PROJECT_SOURCE_DIR}/CMakeLists.txt ${host_files})
add_executable(edsc::edsc IMPORTED GLOBAL)
set_target_properties(edsc::edsc PROPERTIES IMPORTED_LOCATION ${host_program})
add_dependencies(edsc::edsc edsc_host)
