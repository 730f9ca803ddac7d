# Read by cpack before it makes packages: SOURCE_DATE_EPOCH, the time of all files in them, is the time of the commit, so that
# packages of a commit are the same everywhere. Without git it is a fixed time.
if(NOT DEFINED ENV{SOURCE_DATE_EPOCH})
  set(ENV{SOURCE_DATE_EPOCH} 1767225600) # 2026-01-01
  find_program(GIT git)
  if(GIT AND EXISTS ${CPACK_EDSC_SOURCE_DIR}/.git)
    execute_process(COMMAND ${GIT} -C ${CPACK_EDSC_SOURCE_DIR} log -1 --format=%ct OUTPUT_VARIABLE date ERROR_QUIET
                    RESULT_VARIABLE failed OUTPUT_STRIP_TRAILING_WHITESPACE)
    if(NOT failed)
      set(ENV{SOURCE_DATE_EPOCH} ${date})
    endif()
  endif()
endif()
