#include "decode/formats/log_formats.hpp"

#include <algorithm>
#include <iterator>

#include "text/ascii.hpp"

namespace edsc {
namespace {

/// Files that are not read, but given as a log.
struct ForeignRow {
  std::string_view beginning;  ///< of the file; empty: it has `word` in one of its first lines
  std::string_view conversion;
  std::string_view word = {};  ///< in lower case
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
    {"MDF     ", "an MDF file; export it as ASC"},
    {"PAR1", "a Parquet file; DuckDB writes it as CSV"},
    {"", "a trace of IXXAT (MiniMon, canAnalyser); save it as Vector ASC", "ascii trace ixxat"},
    {"", "a text log of Kvaser; save it as Vector ASC", "chn identifier flg"},
    {"", "a data sheet, not a log; --node ID=FILE names the data sheet of a node", "[fileinfo]"},
    {"", "a data sheet, not a log; --node ID=FILE names the data sheet of a node", "[deviceinfo]"},
    {"", "an XDD or XDC file, not a log; --node ID=FILE names the data sheet of a node", "<iso15745profilecontainer"},
};

}  // namespace

std::string_view conversion_of(std::string_view beginning) {
  constexpr std::size_t first_lines = 4096;
  const std::string_view first = beginning.substr(0, first_lines);
  const auto* const found = std::ranges::find_if(foreign_rows, [&](const ForeignRow& row) {
    if (!row.beginning.empty()) return beginning.starts_with(row.beginning);
    const auto is_letter = [](char one, char lower) { return to_lower(one) == lower; };
    return std::search(first.begin(), first.end(), row.word.begin(), row.word.end(), is_letter) != first.end();
  });
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
