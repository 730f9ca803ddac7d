include(${CMAKE_CURRENT_LIST_DIR}/EdscAddDictionary.cmake)
include(CheckCXXSourceCompiles)

# edsc_add_firmware(TARGET EDS file BOARD board SOURCES file... [NAMESPACE name] [NODE_ID n] [OPTIONS file] [STATIC_MAPPING]
#                   [NO_LTO] [FLASH_LIMIT bytes] [RAM_LIMIT bytes])
#
# Makes an image for a Cortex-M from an EDS or DCF and sources with a `main`, in a build with a toolchain file for it:
# TARGET.elf, .hex and .bin, TARGET.map, TARGET.report.txt with the sizes of symbols and of the objects of the EDS, and
# TARGET.cdx.json, a bill of materials in CycloneDX 1.5.
#
#   edsc_add_firmware(drive EDS drive.eds BOARD mps2-an385 NODE_ID 5 SOURCES main.cpp FLASH_LIMIT 16000)
#
# BOARD        a folder in boards/ beside this file, or another folder with the same files (docs/porting.md).
# NAMESPACE    of the dictionary; default: from the file name of the EDS, cpc_tc1 for cpc-tc1.eds.
# NO_LTO       compiles each source for itself. By default the image is optimised when it is linked (-flto), where the toolchain
#              can do that.
# NODE_ID      also defined for the sources as EDSC_NODE_ID.
# FLASH_LIMIT  bytes; a larger image is an error, which lists the largest symbols and objects.
# RAM_LIMIT    the same for RAM, without the stack.
# NODE_ID, OPTIONS and STATIC_MAPPING are those of edsc_add_dictionary.
#
# Without CMAKE_BUILD_TYPE, and without -O in CMAKE_CXX_FLAGS, images are compiled with -Os.
#
# The macros EDSC_DEVICE, the device type, and EDSC_DEVICE_HEADER, its header, are defined for the sources. There is no heap:
# code that calls malloc or operator new does not link.
function(edsc_add_firmware target)
  cmake_parse_arguments(PARSE_ARGV 1 arg "STATIC_MAPPING;NO_LTO" "EDS;BOARD;NAMESPACE;NODE_ID;OPTIONS;FLASH_LIMIT;RAM_LIMIT" "SOURCES")
  if(arg_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "edsc_add_firmware(${target}): unknown arguments: ${arg_UNPARSED_ARGUMENTS}")
  endif()
  foreach(needed IN ITEMS EDS BOARD SOURCES)
    if(NOT arg_${needed})
      message(FATAL_ERROR "edsc_add_firmware(${target}): ${needed} is missing")
    endif()
  endforeach()
  if(NOT CMAKE_CROSSCOMPILING)
    message(FATAL_ERROR "edsc_add_firmware(${target}): the build is for the host; give it a toolchain file")
  endif()
  if(NOT arg_NAMESPACE)
    get_filename_component(stem ${arg_EDS} NAME_WE)
    string(MAKE_C_IDENTIFIER ${stem} arg_NAMESPACE)
  endif()

  set(dictionary_arguments EDS ${arg_EDS} NAMESPACE ${arg_NAMESPACE})
  foreach(argument IN ITEMS NODE_ID OPTIONS)
    if(arg_${argument})
      list(APPEND dictionary_arguments ${argument} ${arg_${argument}})
    endif()
  endforeach()
  if(arg_STATIC_MAPPING)
    list(APPEND dictionary_arguments STATIC_MAPPING)
  endif()
  edsc_add_dictionary(${target}_dictionary ${dictionary_arguments})
  set(dictionary ${CMAKE_CURRENT_BINARY_DIR}/edsc/${target}_dictionary/${arg_NAMESPACE}/dictionary.hpp)

  edsc_add_board(${arg_BOARD} board)
  add_executable(${target} ${arg_SOURCES})
  target_link_libraries(${target} PRIVATE ${target}_dictionary ${board})
  target_compile_definitions(${target} PRIVATE EDSC_DEVICE=${arg_NAMESPACE}::Device
                                               EDSC_DEVICE_HEADER=<${arg_NAMESPACE}/device.hpp>)
  if(arg_NODE_ID)
    target_compile_definitions(${target} PRIVATE EDSC_NODE_ID=${arg_NODE_ID})
  endif()
  _edsc_lto_flags(lto)
  if(lto AND NOT arg_NO_LTO)
    target_compile_options(${target} PRIVATE ${lto})
    target_link_options(${target} PRIVATE ${lto})
  elseif(lto)
    target_link_options(${target} PRIVATE -fno-lto) # the board's objects can be linked either way
  endif()
  set(map ${CMAKE_CURRENT_BINARY_DIR}/${target}.map)
  target_link_options(${target} PRIVATE -Wl,-Map=${map})
  set_target_properties(${target} PROPERTIES SUFFIX .elf ADDITIONAL_CLEAN_FILES ${map})

  find_package(Python3 3.11 REQUIRED COMPONENTS Interpreter)
  set(image ${CMAKE_CURRENT_BINARY_DIR}/${target})
  string(REGEX REPLACE "g\\+\\+(\\.exe)?$" "" prefix ${CMAKE_CXX_COMPILER})
  set(report_arguments --prefix ${prefix})
  if(arg_FLASH_LIMIT)
    list(APPEND report_arguments --flash-limit ${arg_FLASH_LIMIT})
  endif()
  if(arg_RAM_LIMIT)
    list(APPEND report_arguments --ram-limit ${arg_RAM_LIMIT})
  endif()

  # The bill of materials has the hashes of these files, also if a change of them does not change the headers.
  get_filename_component(eds ${arg_EDS} ABSOLUTE)
  set(inputs ${eds})
  if(arg_OPTIONS)
    get_filename_component(options ${arg_OPTIONS} ABSOLUTE)
  else()
    string(REGEX REPLACE "\\.[^.]*$" ".options.json" options ${eds})
  endif()
  if(EXISTS ${options})
    list(APPEND inputs ${options})
  endif()
  set_property(TARGET ${target} APPEND PROPERTY LINK_DEPENDS ${inputs})
  list(TRANSFORM inputs PREPEND "--file;" OUTPUT_VARIABLE bill_files)
  add_custom_command(
    TARGET ${target} POST_BUILD
    COMMAND ${CMAKE_OBJCOPY} -O ihex $<TARGET_FILE:${target}> ${image}.hex
    COMMAND ${CMAKE_OBJCOPY} -O binary $<TARGET_FILE:${target}> ${image}.bin
    COMMAND Python3::Interpreter ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/firmware_report.py $<TARGET_FILE:${target}> ${dictionary}
            ${image}.report.txt ${report_arguments}
    COMMAND Python3::Interpreter ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/firmware_bill.py ${image}.bin ${image}.cdx.json --name ${target}
            --edsc $<TARGET_FILE:edsc::edsc> --compiler ${CMAKE_CXX_COMPILER} ${bill_files}
    BYPRODUCTS ${image}.hex ${image}.bin ${image}.report.txt ${image}.cdx.json
    VERBATIM)
endfunction()

# _edsc_lto_flags(VARIABLE) sets VARIABLE to the flags for optimisation by the linker, empty if the toolchain does not have it.
# check_ipo_supported does not tell this of a bare-metal toolchain: its program needs a C library with system calls.
function(_edsc_lto_flags variable)
  set(flags -flto=auto)
  set(CMAKE_TRY_COMPILE_TARGET_TYPE EXECUTABLE)
  set(CMAKE_REQUIRED_FLAGS ${flags})
  set(CMAKE_REQUIRED_LINK_OPTIONS -nostdlib -nostartfiles -Wl,--entry=main)
  set(CMAKE_REQUIRED_QUIET TRUE)
  check_cxx_source_compiles("int main() { return 0; }" EDSC_HAS_LTO)
  if(NOT EDSC_HAS_LTO)
    set(flags "")
  endif()
  set(${variable} ${flags} PARENT_SCOPE)
endfunction()

# edsc_add_board(BOARD VARIABLE) adds a target with the start-up code and drivers of a board, and the flags for everything that
# is linked with it; VARIABLE is set to its name. The board's folder has
#   board.cmake  sets board_cpu, the value of -mcpu, and board_sources, which define the functions of board.hpp; also
#                board_flash_page and board_flash_word if they are not 2048 and 4 bytes
#   memory.ld    defines the memory regions `flash` and `ram`
# The folder is also an include folder of the program.
function(edsc_add_board board variable)
  set(folder ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/boards/${board})
  if(NOT EXISTS ${folder}/board.cmake)
    get_filename_component(folder ${board} ABSOLUTE)
  endif()
  if(NOT EXISTS ${folder}/board.cmake)
    message(FATAL_ERROR "edsc_add_firmware: there is no board ${board}, and no folder of this name with a board.cmake")
  endif()
  get_filename_component(name ${folder} NAME)
  set(target edsc_board_${name})
  set(${variable} ${target} PARENT_SCOPE)
  if(TARGET ${target})
    return()
  endif()

  unset(board_flash_page)
  unset(board_flash_word)
  include(${folder}/board.cmake)
  set(boards ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/boards)
  set(cpu -mcpu=${board_cpu} -mthumb)
  add_library(${target} OBJECT ${boards}/startup.cpp ${board_sources})
  target_include_directories(${target} PUBLIC ${boards} ${folder})
  if(board_flash_page)
    target_compile_definitions(${target} PUBLIC EDSC_BOARD_FLASH_PAGE=${board_flash_page})
  endif()
  if(board_flash_word)
    target_compile_definitions(${target} PUBLIC EDSC_BOARD_FLASH_WORD=${board_flash_word})
  endif()
  target_link_libraries(${target} PUBLIC edsc::runtime)
  target_compile_options(${target} PUBLIC ${cpu} -ffunction-sections -fdata-sections -fno-exceptions -fno-rtti
                                          -fno-threadsafe-statics)
  _edsc_lto_flags(lto)
  if(lto)
    target_compile_options(${target} PRIVATE ${lto} -ffat-lto-objects)
  endif()
  # Without -O the image would be five times as large.
  if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES AND NOT CMAKE_CXX_FLAGS MATCHES "(^| )-O")
    message(STATUS "edsc_add_firmware: CMAKE_BUILD_TYPE is not set: images are compiled with -Os")
    target_compile_options(${target} PUBLIC -Os)
  endif()
  set(no_heap malloc calloc realloc free _malloc_r _calloc_r _realloc_r _free_r)
  list(TRANSFORM no_heap PREPEND -Wl,--wrap=) # __wrap_malloc does not exist
  target_link_options(
    ${target} PUBLIC ${cpu} -nostartfiles -nostdlib -Wl,--gc-sections ${no_heap} -L${folder} -T${boards}/sections.ld)
  target_link_libraries(${target} PUBLIC -Wl,--start-group -lc_nano -lgcc -Wl,--end-group)
  set_property(TARGET ${target} APPEND PROPERTY INTERFACE_LINK_DEPENDS ${boards}/sections.ld ${folder}/memory.ld)
endfunction()
