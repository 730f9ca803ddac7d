# The target `mutation`: changes one line of the sources at a time and prints the changes that the tests do not detect.
# Fails below 95 %. EDSC_MUTATION_ARGUMENTS selects the lines: those that differ from a git reference, or a sample of all.
set(EDSC_MUTATION_ARGUMENTS "--against origin/main" CACHE STRING "Arguments of tests/mutation/mutation.py")
separate_arguments(mutation_arguments UNIX_COMMAND "${EDSC_MUTATION_ARGUMENTS}")
add_custom_target(
  mutation
  COMMAND ${debian_python} ${CMAKE_CURRENT_SOURCE_DIR}/mutation.py ${mutation_arguments}
          --folder ${PROJECT_BINARY_DIR}/mutated --edsc $<TARGET_FILE:edsc>
  WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}
  COMMENT "Mutants of the runtime and the generator"
  USES_TERMINAL VERBATIM)
add_dependencies(mutation edsc)
