#include "eds/sections/keys.hpp"

#include <fmt/format.h>

#include <charconv>
#include <system_error>

#include "diagnostics/quote.hpp"
#include "eds/number.hpp"
#include "text/ascii.hpp"
#include "text/suggestion.hpp"

namespace edsc {
namespace {

constexpr std::size_t index_digits_of_key = 4;

std::optional<std::uint64_t> read_decimal(std::string_view digits) {
  if (digits.empty() || !std::ranges::all_of(digits, is_digit)) return std::nullopt;
  std::uint64_t number = 0;
  const char* const end = digits.data() + digits.size();
  return std::from_chars(digits.data(), end, number).ec == std::errc() ? std::optional{number} : std::nullopt;
}

std::optional<std::uint64_t> read_number_of_key(Numbering numbering, std::string_view digits) {
  switch (numbering) {
    case Numbering::none: break;
    case Numbering::decimal: return read_decimal(digits);
    case Numbering::c: return parse_unsigned(digits);
    case Numbering::hex4:
      if (digits.size() == index_digits_of_key) return parse_hex(digits, index_digits_of_key);
      break;
  }
  return std::nullopt;
}

}  // namespace

Field make_field(const SourceFile& source, const IniEntry& entry) {
  return {value_of(source, entry), value_position(source, entry), true};
}

std::optional<std::uint32_t> match_key(const SectionKey& row, std::string_view key) {
  if (!row.is_numbered()) return equal_ignoring_case(row.name, key) ? std::optional{0U} : std::nullopt;
  if (!starts_with_ignoring_case(key, row.name)) return std::nullopt;
  const auto number = read_number_of_key(row.numbering, key.substr(row.name.size()));
  if (!number || *number < row.first_number || *number > row.last_number) return std::nullopt;
  return static_cast<std::uint32_t>(*number);
}

std::string spell_numbered_key(const SectionKey& row, std::uint32_t number) {
  switch (row.numbering) {
    case Numbering::none: break;
    case Numbering::decimal:
    case Numbering::c: return fmt::format("{}{}", row.name, number);
    case Numbering::hex4: return fmt::format("{}{:04X}", row.name, number);
  }
  return std::string{row.name};
}

void remove_quotes(ValueKind kind, Field& field, Diagnostics& diagnostics) {
  if (kind == ValueKind::text || kind == ValueKind::typed) return;  // the reader of the value knows its type
  const std::string_view text = without_quotes(trim(field.text));
  if (text.size() == trim(field.text).size()) return;
  diagnostics.warning("number-spelling", field.position,
                      fmt::format("{} must be written without quotation marks",
                                  kind == ValueKind::access ? "an access type" : "a number"),
                      {}, "quotes");
  field.text = text;
}

void report_unknown_key(const SourceFile& source, const IniSection& section, const IniEntry& entry,
                        std::span<const std::string_view> known, Diagnostics& diagnostics) {
  const bool is_listed = !diagnostics.counts_only("unknown-key", Severity::warning, &source);
  diagnostics.warning("unknown-key", key_position(source, entry),
                      fmt::format("unknown key {} in section {}; ignored{}", quote(entry.key), quote(section.name),
                                  is_listed ? did_you_mean(entry.key, known) : ""));
}

}  // namespace edsc
