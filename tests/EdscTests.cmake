# edsc_add_gtest(NAME LABEL label SOURCES file... [LIBRARIES target...] [NO_COVERAGE]): a GoogleTest program. Its includes are
# relative to tests/.
# NO_COVERAGE: it does not cover the runtime, or covers no more than others that compile faster.
function(edsc_add_gtest name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "NO_COVERAGE" "LABEL" "SOURCES;LIBRARIES")
  add_executable(${name} ${arg_SOURCES})
  target_include_directories(${name} PRIVATE ${EDSC_TESTS_DIR})
  # Hundreds of small tests over inlined templates: with more than -O1 they take minutes to compile.
  target_compile_options(${name} PRIVATE ${EDSC_WARNINGS} -O1)
  target_link_libraries(${name} PRIVATE ${arg_LIBRARIES} GTest::gtest_main)
  if(EDSC_COVERAGE AND NOT arg_NO_COVERAGE)
    target_compile_options(${name} PRIVATE -O0 --coverage)
    target_link_options(${name} PRIVATE --coverage)
    set_property(GLOBAL APPEND PROPERTY edsc_covering_tests ${name})
  endif()
  add_test(NAME ${name} COMMAND ${name} --gtest_brief=1)
  set_tests_properties(${name} PROPERTIES LABELS ${arg_LABEL})
endfunction()

# edsc_add_script(NAME LABEL label SCRIPT file [ARGUMENTS argument...] [PROPERTIES property value...]):
# a Python script, called with the source folder and its arguments; exit code 77 means skipped.
function(edsc_add_script name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "LABEL;SCRIPT" "ARGUMENTS;PROPERTIES")
  add_test(NAME ${name} COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/${arg_SCRIPT} ${PROJECT_SOURCE_DIR}
                                ${arg_ARGUMENTS})
  set_tests_properties(${name} PROPERTIES LABELS ${arg_LABEL} SKIP_RETURN_CODE 77
                                          ENVIRONMENT PYTHONDONTWRITEBYTECODE=1 ${arg_PROPERTIES})
endfunction()
