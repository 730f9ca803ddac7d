#include "text/encoding.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>

#include "text/ascii.hpp"

namespace edsc {
namespace {

struct EncodingRow {
  Encoding encoding;
  std::string_view name;
  std::array<std::string_view, 4> aliases{};  ///< in lower case, without `-`, `_` and blanks
};

constexpr EncodingRow encoding_rows[] = {
    {Encoding::ascii, "ASCII"},
    {Encoding::utf8, "UTF-8"},
    {Encoding::utf16_le, "UTF-16LE"},
    {Encoding::utf16_be, "UTF-16BE"},
    {Encoding::cp1252, "CP1252", {"windows1252", "latin1", "iso88591"}},
    {Encoding::cp437, "CP437", {"ibm437"}},
    {Encoding::cp850, "CP850", {"ibm850"}},
    {Encoding::cp1250, "CP1250", {"windows1250"}},
    {Encoding::cp1251, "CP1251", {"windows1251"}},
    {Encoding::shift_jis, "Shift-JIS", {"sjis", "cp932", "windows31j"}},
    {Encoding::gb18030, "GB18030", {"gbk", "gb2312", "cp936"}},
    {Encoding::big5, "Big5", {"cp950"}},
    {Encoding::cp949, "CP949", {"euckr", "uhc"}},
    {Encoding::unknown, "an unknown encoding"},
};

constexpr bool rows_are_in_order() {
  for (std::size_t i = 0; i < std::size(encoding_rows); ++i) {
    if (static_cast<std::size_t>(encoding_rows[i].encoding) != i) return false;
  }
  return true;
}
static_assert(rows_are_in_order());

constexpr bool has_name(Encoding encoding) { return encoding != Encoding::ascii && encoding != Encoding::unknown; }

/// `Shift_JIS` -> `shiftjis`.
std::string plain_name(std::string_view name) {
  std::string plain;
  for (const char c : name) {
    if (c != '-' && c != '_' && c != ' ') plain += to_lower(c);
  }
  return plain;
}

}  // namespace

std::string_view to_string(Encoding encoding) { return encoding_rows[static_cast<std::size_t>(encoding)].name; }

std::optional<Encoding> find_encoding(std::string_view name) {
  const std::string plain = plain_name(name);
  if (plain.empty()) return std::nullopt;
  for (const EncodingRow& row : encoding_rows) {
    const bool is_alias = std::ranges::find(row.aliases, plain) != row.aliases.end();
    if (has_name(row.encoding) && (is_alias || plain_name(row.name) == plain)) return row.encoding;
  }
  return std::nullopt;
}

std::string encoding_names() {
  std::string names;
  for (const EncodingRow& row : encoding_rows) {
    if (has_name(row.encoding)) names.append(names.empty() ? "" : ", ").append(row.name);
  }
  return names;
}

}  // namespace edsc
