#include "decode/formats/log_formats.hpp"

#include <algorithm>
#include <iterator>

namespace edsc {
namespace {

/// Files that are not read, but given as a log.
struct ForeignRow {
  std::string_view beginning, conversion;
};

constexpr ForeignRow foreign_rows[] = {
    {"\x1F\x8B", "compressed with gzip; use zcat and LOG -"},
    {"\x28\xB5\x2F\xFD", "compressed with zstd; use zstdcat and LOG -"},
    {"\xFD"
     "7zXZ",
     "compressed with xz; use xzcat and LOG -"},
    {"PK\x03\x04", "a zip archive; unpack it"},
    {"\xFF\xFE", "text in UTF-16; use iconv -f UTF-16 -t UTF-8"},
    {"\xFE\xFF", "text in UTF-16; use iconv -f UTF-16 -t UTF-8"},
    {"LOGG\x90", "a BLF file of Vector; export it as ASC"},
    {"MDF     ", "an MDF file; export it as ASC"},
};

}  // namespace

std::string_view conversion_of(std::string_view beginning) {
  const auto* const found =
      std::ranges::find_if(foreign_rows, [&](const ForeignRow& row) { return beginning.starts_with(row.beginning); });
  return found == std::end(foreign_rows) ? std::string_view{} : found->conversion;
}

const LogFormat& detect_format(LogInput& input) {
  return **std::ranges::find_if(log_formats, [&](const LogFormat* row) { return row->is_format(input.beginning()); });
}

const LogFormat* find_format(std::string_view name) {
  const auto* const found = std::ranges::find(log_formats, name, &LogFormat::name);
  return found == std::end(log_formats) ? nullptr : *found;
}

}  // namespace edsc
