# What the tests of the label `unit` run.
add_custom_target(unit_programs)

# edsc_add_test_program(NAME [LONG] SOURCE...): a program of the label `unit`, without its test. The whole suite builds it once,
# with the sanitizers. Hundreds of small tests over inlined templates take longer to compile than to run: only those that run
# for LONG are optimised, and no program with more than -O1.
function(edsc_add_test_program name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "LONG" "" "")
  add_executable(${name} ${arg_UNPARSED_ARGUMENTS})
  add_dependencies(unit_programs ${name})
  if(NOT EDSC_GTEST_PROGRAMS)
    set_target_properties(${name} PROPERTIES EXCLUDE_FROM_ALL ON)
  endif()
  target_compile_options(${name} PRIVATE ${EDSC_WARNINGS})
  if(arg_LONG OR NOT EDSC_SANITIZE)
    target_compile_options(${name} PRIVATE -O1)
  endif()
endfunction()

# edsc_add_test_run(NAME COMMAND): the test that runs a program.
function(edsc_add_test_run name)
  if(EDSC_GTEST_PROGRAMS)
    add_test(NAME ${name} COMMAND ${name} ${ARGN})
    set_tests_properties(${name} PROPERTIES LABELS unit)
  endif()
endfunction()

# edsc_precompile_test_headers(NAME FLAG...): the headers of most GoogleTest programs, which take a quarter of the time of a
# test, are compiled once for all programs with the same flags.
function(edsc_precompile_test_headers name)
  string(MAKE_C_IDENTIFIER "edsc_test_headers${ARGN}" headers)
  if(NOT TARGET ${headers})
    set(empty ${CMAKE_BINARY_DIR}/${headers}.cpp)
    file(WRITE ${empty} "")
    add_library(${headers} OBJECT ${empty})
    target_compile_features(${headers} PRIVATE cxx_std_20)
    target_compile_options(${headers} PRIVATE ${ARGN})
    target_link_libraries(${headers} PRIVATE GTest::gtest)
    target_precompile_headers(${headers} PRIVATE <gtest/gtest.h> <chrono> <deque> <optional> <string> <vector>)
  endif()
  target_precompile_headers(${name} REUSE_FROM ${headers})
endfunction()

# edsc_join_sources(VARIABLE NAME): replaces the sources *_test.cpp in a list by joined ones, up to sixteen in each.
function(edsc_join_sources variable name)
  set(tests ${${variable}})
  list(FILTER tests INCLUDE REGEX "_test\\.cpp$")
  list(LENGTH tests count)
  if(count LESS 3)
    return()
  endif()
  set(sources ${${variable}})
  list(REMOVE_ITEM sources ${tests})
  math(EXPR files "(${count} + 15) / 16")
  math(EXPR size "(${count} + ${files} - 1) / ${files}")
  set(script ${EDSC_TESTS_DIR}/support/joined_sources.py)
  foreach(file RANGE 1 ${files})
    math(EXPR first "(${file} - 1) * ${size}")
    list(SUBLIST tests ${first} ${size} group)
    list(TRANSFORM group PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/)
    set(joined ${CMAKE_CURRENT_BINARY_DIR}/${name}_joined_${file}.cpp)
    add_custom_command(
      OUTPUT ${joined}
      COMMAND ${Python3_EXECUTABLE} ${script} ${joined} ${group}
      DEPENDS ${script} ${group}
      COMMENT "Joining tests of ${name}"
      VERBATIM)
    list(APPEND sources ${joined})
  endforeach()
  set(${variable} ${sources} PARENT_SCOPE)
endfunction()

# edsc_add_gtest(NAME SOURCES file... [LIBRARIES target...] [LONG] [NO_COVERAGE] [AS_ON_A_DEVICE] [IN_EDSC|APART]): a GoogleTest
# program. Its includes are relative to tests/. With the sanitizers its sources are compiled together, for time.
# AS_ON_A_DEVICE: no exceptions, no RTTI, no warnings.
# IN_EDSC: they are in namespaces of edsc, and cannot be put in others. APART: they have headers that exclude each other.
# NO_COVERAGE: it does not cover the runtime, or covers no more than others that compile faster.
function(edsc_add_gtest name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "LONG;NO_COVERAGE;AS_ON_A_DEVICE;IN_EDSC;APART" "" "SOURCES;LIBRARIES")
  set(long)
  if(arg_LONG)
    set(long LONG)
  endif()
  if(EDSC_SANITIZE AND NOT arg_IN_EDSC AND NOT arg_APART)
    edsc_join_sources(arg_SOURCES ${name})
  endif()
  edsc_add_test_program(${name} ${long} ${arg_SOURCES})
  if(arg_IN_EDSC)
    set_target_properties(${name} PROPERTIES UNITY_BUILD ${EDSC_UNITY_BUILD} UNITY_BUILD_BATCH_SIZE 16)
    if(EDSC_UNITY_BUILD) # a name at the top of one file does not shadow one in the files after it
      target_compile_options(${name} PRIVATE -Wno-shadow $<$<CXX_COMPILER_ID:GNU>:-Wshadow=local>)
    endif()
  endif()
  target_include_directories(${name} PRIVATE ${EDSC_TESTS_DIR})
  target_link_libraries(${name} PRIVATE ${arg_LIBRARIES} GTest::gtest_main)
  set(flags "")
  if(arg_AS_ON_A_DEVICE)
    set(flags -fno-exceptions -fno-rtti)
    target_compile_options(${name} PRIVATE -Werror ${flags})
  endif()
  if(EDSC_SANITIZE AND NOT arg_LONG)
    edsc_precompile_test_headers(${name} ${flags})
  endif()
  if(EDSC_COVERAGE AND NOT arg_NO_COVERAGE)
    target_compile_options(${name} PRIVATE -O0 --coverage)
    target_link_options(${name} PRIVATE --coverage)
    set_property(GLOBAL APPEND PROPERTY edsc_covering_tests ${name})
  endif()
  edsc_add_test_run(${name} --gtest_brief=1)
endfunction()

# edsc_record_accesses(NAME): a GoogleTest program that records which objects the applications of its nodes use, for the test
# `value_only`.
function(edsc_record_accesses name)
  set(file ${CMAKE_BINARY_DIR}/accesses/${name}.tsv)
  file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/accesses)
  target_compile_definitions(${name} PRIVATE CANOPEN_ACCESS_PROBE="support/access_probe.hpp" EDSC_ACCESS_FILE="${file}")
  if(TEST ${name})
    set_tests_properties(${name} PROPERTIES FIXTURES_SETUP accesses)
  endif()
  set_property(GLOBAL APPEND PROPERTY edsc_access_files ${file})
endfunction()

# `./test.sh quick` also runs these scripts. They take seconds, conform_reference 40 of them.
set(EDSC_QUICK_SCRIPTS check cli cli_diff cli_format completion conform_reference decode golden manuals options rules)

# edsc_add_script(NAME LABEL label SCRIPT file [ARGUMENTS argument...] [PROPERTIES property value...]):
# a Python script, called with the source folder and its arguments; exit code 77 means skipped.
function(edsc_add_script name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "LABEL;SCRIPT" "ARGUMENTS;PROPERTIES")
  if(name IN_LIST EDSC_QUICK_SCRIPTS)
    list(APPEND arg_LABEL quick)
  endif()
  add_test(NAME ${name} COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/${arg_SCRIPT} ${PROJECT_SOURCE_DIR}
                                ${arg_ARGUMENTS})
  set_tests_properties(${name} PROPERTIES LABELS "${arg_LABEL}" SKIP_RETURN_CODE 77
                                          ENVIRONMENT PYTHONDONTWRITEBYTECODE=1 ${arg_PROPERTIES})
endfunction()
