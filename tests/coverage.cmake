# The target `coverage`: runs all GoogleTest programs of the runtime and prints which lines of each of its headers they
# reach and which they do not. Fails below 95 %. The sockets of host/socketcan.hpp are tested in the virtual machine.
find_program(GCOVR gcovr REQUIRED)
get_property(programs GLOBAL PROPERTY edsc_covering_tests)
set(runs)
foreach(program IN LISTS programs)
  list(APPEND runs COMMAND ${program} --gtest_brief=1)
endforeach()
add_custom_target(
  coverage
  ${runs}
  COMMAND ${GCOVR} --root ${PROJECT_SOURCE_DIR} --filter ${PROJECT_SOURCE_DIR}/runtime/ --exclude .*/host/socketcan.hpp
          --exclude .*/host/socketcan_frame.hpp
          --delete --fail-under-line 95 ${CMAKE_CURRENT_BINARY_DIR}
  WORKING_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}
  COMMENT "Line coverage of the runtime"
  USES_TERMINAL VERBATIM)
add_dependencies(coverage ${programs})
