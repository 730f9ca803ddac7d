/// The tables of code pages, which make_code_pages.cpp makes with iconv when edsc is built: a static program and one
/// for Windows cannot load the converters of glibc.
#pragma once

#include <cstdint>
#include <span>

namespace edsc {

/// A character of two bytes beyond FFFFh.
struct WideCharacter {
  std::uint32_t code;
  std::uint32_t code_point;
};

/// FFFDh is undefined. Bytes below 80h are ASCII.
struct CodePageTable {
  std::span<const std::uint16_t> singles;  ///< bytes 80h to FFh
  /// Two bytes: lead bytes 80h to FEh, each with the trail bytes 40h to FEh. Empty if each character is one byte.
  std::span<const std::uint16_t> pairs;
  std::span<const WideCharacter> wide;  ///< of two bytes, which are undefined in `pairs`
};

/// Consecutive codes of four bytes in GB18030, with consecutive code points.
struct FourByteRun {
  std::uint32_t first;  ///< number of the code; 81308130h is 0
  std::uint32_t code_point;
  std::uint32_t length;
};

extern const CodePageTable cp1252_table;
extern const CodePageTable cp437_table;
extern const CodePageTable cp850_table;
extern const CodePageTable cp1250_table;
extern const CodePageTable cp1251_table;
extern const CodePageTable shift_jis_table;
extern const CodePageTable gb18030_table;
extern const CodePageTable big5_table;
extern const CodePageTable cp949_table;
extern const std::span<const FourByteRun> gb18030_four_bytes;  ///< ascending

}  // namespace edsc
