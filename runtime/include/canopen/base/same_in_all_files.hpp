/// Properties that all files of an image must have in common, checked by the linker.
#pragma once

/// Files with another value of this symbol are not linked: "multiple definition of `symbol`", with link-time
/// optimization the text below. `value` is a number other than 0, in quotes. The symbol is absolute: it has no place in
/// flash or RAM, and a linker for ELF accepts several definitions with the same value.
///
/// Clang's link-time optimization accepts weak definitions only. Of a program that is compiled with Clang, therefore,
/// just this optimization detects files with different values.
#ifdef __ELF__
#ifdef __clang__
#define CANOPEN_SYMBOL_BINDING ".weak "
#else
#define CANOPEN_SYMBOL_BINDING ".globl "
#endif
#define CANOPEN_SAME_IN_ALL_FILES(symbol, value)                                                                       \
  asm(".ifdef " symbol "\n.if " symbol " != " value "\n.error \"" symbol                                               \
      ": the files of an image must be compiled alike, see docs/porting.md\"\n.endif\n.endif\n" CANOPEN_SYMBOL_BINDING \
          symbol "\n.hidden " symbol "\n.set " symbol ", " value "\n")
#else
#define CANOPEN_SAME_IN_ALL_FILES(symbol, value) static_assert(true)
#endif
