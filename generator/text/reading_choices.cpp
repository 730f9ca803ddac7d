#include "text/reading_choices.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>

#include "text/ascii.hpp"

namespace edsc {
namespace {

bool is_same_word(std::string_view a, std::string_view b) { return std::ranges::equal(a, b, {}, to_lower, to_lower); }

/// Sets `choice` to the enumerator whose name is `value`.
template <typename Enum, std::size_t count>
bool set_by_name(std::string_view value, const std::array<std::string_view, count>& names, Enum& choice) {
  const auto found = std::ranges::find_if(names, [&](std::string_view name) { return is_same_word(name, value); });
  if (found == names.end()) return false;
  choice = static_cast<Enum>(found - names.begin());
  return true;
}

constexpr std::array<std::string_view, 2> notation_names = {"hexadecimal", "decimal"};
constexpr std::array<std::string_view, 2> convention_names = {"cia306", "swapped"};

std::string either(const std::array<std::string_view, 2>& names) {
  return std::string{names[0]}.append(" or ").append(names[1]);
}

constexpr ReadingChoiceRow choice_rows[] = {
    {"sub_indices", "SubIndices", "notation of the sub-indices in section names",
     [](std::string_view value, ReadingChoices& choices) {
       return set_by_name(value, notation_names, choices.sub_indices);
     },
     [] { return either(notation_names); }},
    {"encoding", "Encoding", "encoding of the text",
     [](std::string_view value, ReadingChoices& choices) {
       const std::optional<Encoding> found = find_encoding(value);
       if (found) choices.encoding = found;
       return found.has_value();
     },
     [] { return "one of " + encoding_names(); }},
    {"access_types", "AccessTypes", "swapped: rwr and rww are exchanged",
     [](std::string_view value, ReadingChoices& choices) {
       return set_by_name(value, convention_names, choices.access_types);
     },
     [] { return either(convention_names); }},
};

}  // namespace

std::span<const ReadingChoiceRow> reading_choice_rows() { return choice_rows; }

const ReadingChoiceRow* find_reading_option(std::string_view option) {
  const auto* const found = std::ranges::find(choice_rows, option, &ReadingChoiceRow::option);
  return found == std::end(choice_rows) ? nullptr : found;
}

const ReadingChoiceRow* find_reading_key(std::string_view key) {
  const auto* const found =
      std::ranges::find_if(choice_rows, [&](const ReadingChoiceRow& row) { return is_same_word(row.key, key); });
  return found == std::end(choice_rows) ? nullptr : found;
}

}  // namespace edsc
