# ST Nucleo-64 with an STM32G474RE: Cortex-M4, with FDCAN1 on PA11 and PA12, which need a transceiver.
set(board_cpu cortex-m4)
set(board_sources ${CMAKE_CURRENT_LIST_DIR}/board.cpp)
set(board_flash_word 8)
