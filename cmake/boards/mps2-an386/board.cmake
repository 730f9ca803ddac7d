# Arm MPS2 with application note AN386: Cortex-M4. QEMU: -M mps2-an386.
set(board_cpu cortex-m4)
set(board_sources ${CMAKE_CURRENT_LIST_DIR}/../mps2/board.cpp)
