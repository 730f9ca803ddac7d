#include "shared/object_words.hpp"

#include <algorithm>
#include <canopen/od/access.hpp>
#include <iterator>

#include "device/types/type_name.hpp"
#include "eds/number.hpp"
#include "lookup/find_entry.hpp"
#include "shared/parse_number.hpp"
#include "text/ascii.hpp"

namespace edsc {
namespace {

/// The text before a character, which is removed with it; all of the text without the character.
std::string_view take_until(std::string_view& text, char end) {
  const std::size_t at = text.find(end);
  const std::string_view part = text.substr(0, at);
  text.remove_prefix(at == std::string_view::npos ? text.size() : at + 1);
  return part;
}

/// `NAME[8]`: the name, and the number.
struct CountedWord {
  std::string_view word;
  std::optional<std::uint8_t> count;
};
std::optional<CountedWord> read_counted_word(std::string_view text) {
  const std::size_t bracket = text.find('[');
  if (bracket == std::string_view::npos) return CountedWord{text, std::nullopt};
  if (!text.ends_with(']')) return std::nullopt;
  const auto count = parse_number(text.substr(bracket + 1, text.size() - bracket - 2), 254);
  if (!count || *count == 0) return std::nullopt;
  return CountedWord{text.substr(0, bracket), static_cast<std::uint8_t>(*count)};
}

}  // namespace

std::optional<ObjectRange> read_object_range(std::string_view word) {
  const std::size_t dash = word.find('-');
  const auto first = parse_entry_address(word.substr(0, dash));
  if (!first) return std::nullopt;
  ObjectRange range{first->index, first->index, first->sub_index, first->sub_index};
  if (dash == std::string_view::npos) return range;
  const std::string_view end = word.substr(dash + 1);
  if (first->sub_index) {
    const auto last = parse_hex(end.ends_with('h') ? end.substr(0, end.size() - 1) : end, 2);
    if (!last || *last < *first->sub_index) return std::nullopt;
    range.last_sub = static_cast<std::uint8_t>(*last);
    return range;
  }
  const auto last = parse_entry_address(end);
  if (!last || last->sub_index || last->index < first->index) return std::nullopt;
  range.last = last->index;
  return range;
}

std::optional<CountedIndex> read_counted_index(std::string_view word) {
  const auto counted = read_counted_word(word);
  const auto address = counted ? parse_entry_address(counted->word) : std::nullopt;
  if (!address || address->sub_index) return std::nullopt;
  return CountedIndex{address->index, counted->count.value_or(1)};
}

std::optional<CountedType> read_counted_type(std::string_view word) {
  const auto counted = read_counted_word(word);
  const canopen::DataTypeRow* const type = counted ? find_type_by_name(counted->word) : nullptr;
  if (type == nullptr) return std::nullopt;
  return CountedType{type, counted->count};
}

std::optional<std::vector<NewValue>> read_record(std::string_view text) {
  std::vector<NewValue> values;
  while (!text.empty()) {
    std::string_view part = take_until(text, ',');
    const std::string_view name = trim(take_until(part, ':'));
    const canopen::DataTypeRow* const type = find_type_by_name(trim(take_until(part, ':')));
    const std::string_view access = trim(take_until(part, '='));
    if (name.empty() || type == nullptr || !is_access_text(access)) return std::nullopt;
    NewValue value{std::string{name}, type, std::string{access}};
    value.default_value = trim(part);
    if (value.default_value.empty() && type->bits != 0) value.default_value = "0";
    values.push_back(std::move(value));
  }
  return values.empty() || values.size() > 254 ? std::nullopt : std::optional{std::move(values)};
}

FactorAndUnit read_unit(std::string_view text) {
  text = trim(text);
  const std::size_t blank = text.find(' ');
  const std::string_view first = text.substr(0, blank);
  if (blank == std::string_view::npos || !parse_real(first)) return {"", std::string{text}};
  return {std::string{first}, std::string{trim(text.substr(blank))}};
}

bool is_access_text(std::string_view text) {
  return std::ranges::find(canopen::access_rows, text, &canopen::AccessRow::name) != std::end(canopen::access_rows);
}

}  // namespace edsc
