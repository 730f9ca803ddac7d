# Run by cpack on the files of each package, the last of these scripts: sets their times (package_date.cmake).
find_program(TOUCH touch REQUIRED)
file(GLOB_RECURSE files LIST_DIRECTORIES true ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/*)
foreach(file IN LISTS files ITEMS ${CPACK_TEMPORARY_INSTALL_DIRECTORY})
  execute_process(COMMAND ${TOUCH} -h -d @$ENV{SOURCE_DATE_EPOCH} ${file} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
