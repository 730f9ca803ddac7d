# Linux on a 64-bit Arm with Debian's g++-aarch64-linux-gnu. Where qemu-user-static is installed, programs of the build can run
# on this machine.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)

set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
find_program(EDSC_QEMU_AARCH64 NAMES qemu-aarch64-static qemu-aarch64)
if(EDSC_QEMU_AARCH64)
  set(CMAKE_CROSSCOMPILING_EMULATOR ${EDSC_QEMU_AARCH64})
endif()

set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
