# BBC micro:bit with an nRF51822: Cortex-M0, which has the instruction set of the Cortex-M0+. QEMU: -M microbit.
set(board_cpu cortex-m0plus)
set(board_sources ${CMAKE_CURRENT_LIST_DIR}/board.cpp)
