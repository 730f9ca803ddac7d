# Bare-metal Arm with GCC. EDSC_ARM_CPU selects the core (default: Cortex-M0+).
#
#   cmake -B build --toolchain cmake/toolchains/arm-none-eabi.cmake -DEDSC_ARM_CPU=cortex-m4
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR arm)

set(EDSC_ARM_CPU cortex-m0plus CACHE STRING "core that the firmware is for: the value of -mcpu")
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES EDSC_ARM_CPU)

set(CMAKE_C_COMPILER arm-none-eabi-gcc)
set(CMAKE_CXX_COMPILER arm-none-eabi-g++)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)  # linking needs a linker script

set(flags "-mcpu=${EDSC_ARM_CPU} -mthumb -ffunction-sections -fdata-sections")
set(CMAKE_C_FLAGS_INIT "${flags}")
set(CMAKE_ASM_FLAGS_INIT "${flags}")
set(CMAKE_CXX_FLAGS_INIT "${flags} -fno-exceptions -fno-rtti -fno-threadsafe-statics")
set(CMAKE_EXE_LINKER_FLAGS_INIT "-Wl,--gc-sections")
set(CMAKE_CXX_FLAGS_RELEASE "-Os -DNDEBUG" CACHE STRING "flags of a release") # CMake would add -O3 after an _INIT value

set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
