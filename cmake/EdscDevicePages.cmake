# The target device_pages writes docs/devices/NAME.html and NAME.md in the build folder, pages of each reference device of eds/.
file(GLOB device_sheets CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/eds/*.eds)
set(device_pages)
foreach(sheet IN LISTS device_sheets)
  get_filename_component(name ${sheet} NAME_WE)
  set(inputs ${sheet})
  if(EXISTS ${PROJECT_SOURCE_DIR}/eds/${name}.options.json)
    list(APPEND inputs ${PROJECT_SOURCE_DIR}/eds/${name}.options.json)
  endif()
  foreach(suffix IN ITEMS html md)
    set(page ${PROJECT_BINARY_DIR}/docs/devices/${name}.${suffix})
    add_custom_command(
      OUTPUT ${page}
      COMMAND ${CMAKE_COMMAND} -E make_directory ${PROJECT_BINARY_DIR}/docs/devices
      COMMAND edsc::edsc document ${sheet} -o ${page}
      COMMAND ${CMAKE_COMMAND} -E touch ${page} # edsc does not touch a page that would not change
      DEPENDS edsc::edsc ${inputs}
      COMMENT "Documenting ${name} (${suffix})"
      VERBATIM)
    list(APPEND device_pages ${page})
  endforeach()
endforeach()
add_custom_target(device_pages DEPENDS ${device_pages})
