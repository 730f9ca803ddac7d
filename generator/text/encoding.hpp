/// Encodings of texts, and their names in options and messages.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace edsc {

enum class Encoding : std::uint8_t {
  ascii,
  utf8,
  utf16_le,
  utf16_be,
  cp1252,  ///< western Europe
  cp437,   ///< the DOS code pages 437 and 850, which have the same western European letters
  cp850,
  cp1250,  ///< central Europe
  cp1251,  ///< Cyrillic
  shift_jis,
  gb18030,  ///< also GBK and GB2312, which it contains
  big5,
  cp949,    ///< Korean
  unknown,  ///< not detected: its non-ASCII bytes are U+FFFD
};

/// The name as IANA or Windows has it: `Shift-JIS`.
[[nodiscard]] std::string_view to_string(Encoding encoding);

/// Reads a name of an encoding, also an alias such as `GBK`, `SJIS` or `Windows-1252`; ignores letter case, `-`, `_`
/// and blanks. Returns nothing if there is none. ASCII and `unknown` are not names: a text of ASCII needs no choice.
[[nodiscard]] std::optional<Encoding> find_encoding(std::string_view name);

/// The names that `find_encoding` accepts, without aliases: `UTF-8, UTF-16LE, ...`.
[[nodiscard]] std::string encoding_names();

}  // namespace edsc
