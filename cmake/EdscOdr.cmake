# The target odr fails if two sources of edsc define different types of one name: the linker would keep the functions of one of
# them. Objects of g++ -flto contain the types. The link ends before it makes code, and needs no optimisation.
set(objects "")
foreach(target IN ITEMS edsc edsc_accept edsc_conform edsc_bus edsc_logs edsc_compiler edsc_edit edsc_lsp edsc_documents edsc_device)
  list(APPEND objects $<TARGET_OBJECTS:${target}>)
endforeach()
set(linked ${PROJECT_BINARY_DIR}/odr.o)
add_custom_command(
  OUTPUT ${linked}
  COMMAND ${CMAKE_CXX_COMPILER} -O0 -flto -r -nostdlib -flinker-output=rel -Wodr -Werror=odr ${objects} -o ${linked}
  DEPENDS ${objects}
  COMMENT "Checking the one definition rule"
  COMMAND_EXPAND_LISTS VERBATIM)
add_custom_target(odr DEPENDS ${linked})
