# Run by cpack after it has made a package: writes a .tar.gz again with GNU tar. cpack has its files in the order of the file
# system, and with the user who runs it as their owner.
if(CPACK_GENERATOR STREQUAL "TGZ")
  foreach(archive IN LISTS CPACK_PACKAGE_FILES)
    execute_process(
      COMMAND tar --create --directory ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/.. --sort=name --format=gnu
              --mtime=@$ENV{SOURCE_DATE_EPOCH} --owner=0 --group=0 --numeric-owner ${CPACK_PACKAGE_FILE_NAME}
      COMMAND gzip -9 -n
      OUTPUT_FILE ${archive} COMMAND_ERROR_IS_FATAL ANY)
  endforeach()
endif()
