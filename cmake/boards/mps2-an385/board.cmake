# Arm MPS2 with application note AN385: Cortex-M3. QEMU: -M mps2-an385.
set(board_cpu cortex-m3)
set(board_sources ${CMAKE_CURRENT_LIST_DIR}/../mps2/board.cpp)
