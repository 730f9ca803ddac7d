# Flags of the libraries of edsc itself and of its program. Projects that contain edsc, and code that includes the runtime, keep
# their own.

# edsc reads files of vendors and frames of devices: a memory error must end the program instead of running what the input says.
set(EDSC_HARDENING "")
if(NOT EDSC_SANITIZE AND CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang")
  include(CheckCXXCompilerFlag)
  include(CheckPIESupported)
  check_pie_supported(LANGUAGES CXX)
  check_cxx_compiler_flag(-fcf-protection=full EDSC_HAS_CF_PROTECTION) # CET, of x86
  set(EDSC_HARDENING -fstack-protector-strong $<$<BOOL:${EDSC_HAS_CF_PROTECTION}>:-fcf-protection=full>
                     # glibc warns of it without optimization
                     $<$<CONFIG:Release,RelWithDebInfo,MinSizeRel>:-U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=2>)
  set(EDSC_HARDENING_LINK -Wl,-z,relro,-z,now,-z,noexecstack)
  if(WIN32)
    set(EDSC_HARDENING_LINK -Wl,--dynamicbase,--nxcompat,--high-entropy-va -fstack-protector-strong) # brings libssp
  endif()
endif()

# edsc_set_host_flags(TARGET)
function(edsc_set_host_flags target)
  set(warnings ${EDSC_WARNINGS})
  get_target_property(is_unity ${target} UNITY_BUILD)
  if(is_unity AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # A name at the top of one file of a unity build does not shadow one in the files after it.
    list(TRANSFORM warnings REPLACE "^-Wshadow$" "-Wshadow=local")
    if(CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
      list(APPEND warnings -Wno-array-bounds) # false in g++ 12 for numbers that fmt writes
    endif()
  endif()
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF POSITION_INDEPENDENT_CODE ON)
  # -O3 of a release build takes a tenth longer to compile, and edsc is not faster with it.
  target_compile_options(${target} PRIVATE ${warnings} ${EDSC_HARDENING} $<$<AND:$<CONFIG:Release>,$<CXX_COMPILER_ID:GNU,Clang>>:-O2>)
endfunction()

# edsc_add_host_library(NAME SOURCE...)
#
# A static library of which each folder is compiled as one file: headers and templates that its files share take most of the
# time.
function(edsc_add_host_library name)
  add_library(${name} STATIC ${ARGN})
  target_compile_features(${name} PUBLIC cxx_std_20)
  target_include_directories(${name} PUBLIC ${CMAKE_CURRENT_SOURCE_DIR})
  set_target_properties(${name} PROPERTIES UNITY_BUILD ${EDSC_UNITY_BUILD} UNITY_BUILD_MODE GROUP)
  edsc_set_host_flags(${name})
  if(EDSC_PRECOMPILE_HEADERS AND name STREQUAL "edsc_device")
    target_precompile_headers(
      edsc_device PRIVATE <algorithm> <charconv> <chrono> <filesystem> <functional> <map> <memory> <optional> <ranges> <span>
      <string> <variant> <vector> <fmt/format.h> <nlohmann/json.hpp>)
  elseif(EDSC_PRECOMPILE_HEADERS)
    target_precompile_headers(${name} REUSE_FROM edsc_device)
  endif()
  edsc_group_by_folder(${ARGN})
  if(EDSC_FUZZ_COVERAGE)
    target_compile_options(${name} PRIVATE -fsanitize=fuzzer-no-link)
  endif()
endfunction()

# edsc_add_host_sources(NAME SOURCE...) adds sources to a library of edsc_add_host_library().
function(edsc_add_host_sources name)
  target_sources(${name} PRIVATE ${ARGN})
  edsc_group_by_folder(${ARGN})
endfunction()

function(edsc_group_by_folder)
  list(FILTER ARGN EXCLUDE REGEX "^/")
  foreach(source IN LISTS ARGN)
    cmake_path(GET source PARENT_PATH folder)
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${folder})
  endforeach()
endfunction()
