include(${CMAKE_CURRENT_LIST_DIR}/edscTargets.cmake)
include(${CMAKE_CURRENT_LIST_DIR}/EdscAddFirmware.cmake)
