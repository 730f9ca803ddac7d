#include "eds/sections/keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <system_error>

#include "diagnostics/quote.hpp"
#include "text/ascii.hpp"
#include "text/suggestion.hpp"

namespace edsc {

Field make_field(const SourceFile& source, const IniEntry& entry) {
  return {entry.value, value_position(source, entry), true};
}

Field& numbered_field(std::vector<NumberedField>& fields, std::uint32_t number) {
  const auto at = std::ranges::lower_bound(fields, number, {}, &NumberedField::number);
  return at != fields.end() && at->number == number ? at->field : fields.insert(at, {number, {}})->field;
}

std::optional<std::uint32_t> number_in(const SectionKey& row, std::string_view key) {
  const std::string_view prefix = row.name.substr(0, row.name.size() - 1);
  if (!starts_with_ignoring_case(key, prefix) || key.size() == prefix.size() || !is_digit(key[prefix.size()])) {
    return std::nullopt;
  }
  std::uint32_t number = 0;
  const char* const end = key.data() + key.size();
  const std::from_chars_result result = std::from_chars(key.data() + prefix.size(), end, number);
  return result.ec == std::errc() && result.ptr == end ? std::optional{number} : std::nullopt;
}

void report_unknown_key(const SourceFile& source, const IniSection& section, const IniEntry& entry,
                        std::span<const std::string_view> known, Diagnostics& diagnostics) {
  const bool is_listed = !diagnostics.counts_only("unknown-key", Severity::warning, &source);
  diagnostics.warning("unknown-key", key_position(source, entry),
                      fmt::format("unknown key {} in section {}; it is left out{}", quote(entry.key),
                                  quote(section.name), is_listed ? did_you_mean(entry.key, known) : ""));
}

}  // namespace edsc
