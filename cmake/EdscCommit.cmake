# cmake -DSOURCE_DIR=folder -DOUTPUT=commit.hpp -P EdscCommit.cmake: writes the commit that `edsc --version` prints.
#
# It is empty if SOURCE_DIR is not the root of a git working tree, as with an archive, also inside the working tree of another
# project. Uncommitted changes are indicated. OUTPUT is not written if it would not change.
set(commit "")
find_program(GIT git)
if(GIT AND EXISTS ${SOURCE_DIR}/.git)
  execute_process(COMMAND ${GIT} -C ${SOURCE_DIR} rev-parse --short=12 HEAD OUTPUT_VARIABLE head ERROR_QUIET
                  RESULT_VARIABLE failed OUTPUT_STRIP_TRAILING_WHITESPACE)
  execute_process(COMMAND ${GIT} -C ${SOURCE_DIR} status --porcelain OUTPUT_VARIABLE changes ERROR_QUIET
                  RESULT_VARIABLE unknown)
  if(NOT failed AND NOT unknown)
    set(commit " (commit ${head})")
    if(changes)
      set(commit " (commit ${head} with changes)")
    endif()
  endif()
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "#define EDSC_COMMIT \"${commit}\"\n" @ONLY)
