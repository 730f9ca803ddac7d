#include "eds/sections/section_name.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <optional>

#include "eds/ini.hpp"
#include "eds/number.hpp"
#include "eds/sections/section_keys.hpp"
#include "text/ascii.hpp"

namespace edsc {
namespace {

constexpr std::size_t number_digits = 4;

constexpr std::size_t index_digits = 4;
constexpr std::size_t sub_index_digits = 2;
constexpr std::string_view module_prefix = "M";

constexpr std::string_view title_of(SectionKind kind) { return find_section(kind)->title; }

constexpr std::string_view sub = title_of(SectionKind::sub_object);

constexpr bool has_form(SectionKind kind, NameForm form) {
  const SectionRow* const row = find_section(kind);
  return row != nullptr && row->form == form;
}

/// Removes the decimal number at the start of `text`.
std::optional<std::uint16_t> take_number(std::string_view& text) {
  std::uint16_t number = 0;
  const char* const end = text.data() + std::min(text.size(), number_digits + 1);
  const std::from_chars_result result = std::from_chars(text.data(), end, number);
  const auto digits = static_cast<std::size_t>(result.ptr - text.data());
  if (result.ec != std::errc{} || digits > number_digits) return std::nullopt;
  text.remove_prefix(digits);
  return number;
}

/// Removes a prefix of `text`, ignoring letter case.
bool take_prefix(std::string_view& text, std::string_view prefix) {
  if (!starts_with_ignoring_case(text, prefix)) {
    return false;
  }
  text.remove_prefix(prefix.size());
  return true;
}

/// The section whose name, or its part without the number of the module, is a title of this form.
std::optional<SectionKind> find_title(NameForm form, std::string_view name) {
  for (const SectionRow& row : section_rows) {
    if (row.form == form && equal_ignoring_case(name, row.title)) return row.kind;
  }
  for (const OtherTitle& other : other_titles) {
    if (has_form(other.kind, form) && equal_ignoring_case(name, other.title)) return other.kind;
  }
  return std::nullopt;
}

SectionName with_index(SectionKind kind, std::string_view digits, std::uint16_t index) {
  return {.kind = kind,
          .index = index,
          .remark = digits.size() < index_digits ? "an index has four digits" : std::string_view{}};
}

SectionName malformed(std::string_view remark) { return {.kind = SectionKind::malformed, .remark = remark}; }

constexpr std::size_t decimal_sub_index_digits = 3;

std::optional<std::uint16_t> read_decimal_sub_index(std::string_view text) {
  const bool has_digits =
      !text.empty() && text.size() <= decimal_sub_index_digits && std::ranges::all_of(text, is_digit);
  if (!has_digits) return std::nullopt;
  std::uint16_t number = 0;
  std::from_chars(text.data(), text.data() + text.size(), number);
  return number <= 0xFF ? std::optional{number} : std::nullopt;
}

/// `HHHHsubHH`.
SectionName read_sub_object(std::string_view index_text, std::uint16_t index, std::string_view sub_index_text,
                            SubIndexNotation notation) {
  const bool is_decimal = notation == SubIndexNotation::decimal;
  const std::optional<std::uint16_t> sub_index =
      is_decimal ? read_decimal_sub_index(sub_index_text) : parse_hex(sub_index_text, sub_index_digits);
  if (!sub_index) {
    return malformed(is_decimal ? "with decimal sub-indices, a sub-index has one to three decimal digits, 255 at most"
                                : "a sub-index has one or two hexadecimal digits, FFh at most");
  }
  SectionName result = with_index(SectionKind::sub_object, index_text, index);
  result.sub_index = static_cast<std::uint8_t>(*sub_index);
  return result;
}

/// `1018_1`, `1018.1`, `1018 sub1`: another separator than `sub`.
bool has_other_separator(std::string_view name) {
  if (name.size() <= index_digits || !parse_hex(name.substr(0, index_digits), index_digits)) return false;
  std::string_view rest = name.substr(index_digits);
  if (std::string_view{"_-.:, "}.find(rest.front()) == std::string_view::npos) return false;
  rest = trim(rest.substr(1));
  if (starts_with_ignoring_case(rest, sub)) rest.remove_prefix(sub.size());
  return parse_hex(rest, sub_index_digits).has_value();
}

/// Names that begin with an index.
std::optional<SectionName> read_object(std::string_view name, SubIndexNotation notation) {
  const auto digits_end = std::find_if_not(name.begin(), name.end(), is_hex_digit);
  const auto digits = static_cast<std::size_t>(digits_end - name.begin());
  if (digits == index_digits) {  // most names
    const std::string_view rest = name.substr(digits);
    const bool is_sub_object = starts_with_ignoring_case(rest, sub);
    if (rest.empty() || is_sub_object) {
      const std::uint16_t index = *parse_hex(name.substr(0, digits), index_digits);
      return rest.empty() ? with_index(SectionKind::object, name, index)
                          : read_sub_object(name.substr(0, digits), index, rest.substr(sub.size()), notation);
    }
  }
  if (is_hexadecimal(name)) {
    std::optional<SectionName> object = read_object(name.substr(2), notation);
    if (object && object->kind != SectionKind::malformed) object->remark = "an index is written without 0x";
    return object;
  }
  if (has_other_separator(name)) return malformed("only sub is between index and sub-index, as in 1018sub1");
  if (const std::optional<std::uint16_t> index = parse_hex(name, index_digits)) {
    return with_index(SectionKind::object, name, *index);
  }
  const std::string_view rest = name.substr(digits);
  if (digits > 0 && (rest.empty() || starts_with_ignoring_case(rest, sub))) {
    const std::string_view index_text = name.substr(0, digits);
    const std::optional<std::uint16_t> index = parse_hex(index_text, index_digits);
    return index ? read_sub_object(index_text, *index, rest.substr(sub.size()), notation)
                 : malformed("an index has four hexadecimal digits");
  }
  for (const SectionRow& row : section_rows) {
    if (row.form != NameForm::object || !ends_with_ignoring_case(name, row.title)) continue;
    const std::string_view index_text = name.substr(0, name.size() - row.title.size());
    const std::optional<std::uint16_t> index = parse_hex(index_text, index_digits);
    if (index) return with_index(row.kind, index_text, *index);
  }
  return std::nullopt;
}

/// The part after the module number.
std::optional<SectionName> read_module_part(std::string_view rest, SubIndexNotation notation) {
  if (const std::optional<SectionKind> kind = find_title(NameForm::module, rest)) return SectionName{.kind = *kind};
  for (const SectionRow& row : section_rows) {
    if (row.form == NameForm::module_index && take_prefix(rest, row.title)) {
      const std::optional<std::uint16_t> index = parse_hex(rest, index_digits);
      return index ? with_index(row.kind, rest, *index) : malformed("an index has four hexadecimal digits");
    }
    if (row.form == NameForm::module_object && take_prefix(rest, row.title)) {
      std::optional<SectionName> object = read_object(rest, notation);
      if (object && object->kind != SectionKind::malformed) {
        object->part = object->kind;
        object->kind = row.kind;
      }
      return object;
    }
  }
  return std::nullopt;
}

/// `ToolX`, and names that begin with `MX`.
std::optional<SectionName> read_numbered(std::string_view name, SubIndexNotation notation) {
  std::string_view rest = name;
  if (take_prefix(rest, title_of(SectionKind::tool))) {
    const std::optional<std::uint16_t> number = take_number(rest);
    if (!number || !rest.empty()) return std::nullopt;
    return SectionName{.kind = SectionKind::tool, .number = *number};
  }
  if (!take_prefix(rest, module_prefix)) {
    return std::nullopt;
  }
  const std::optional<std::uint16_t> number = take_number(rest);
  std::optional<SectionName> part = number ? read_module_part(rest, notation) : std::nullopt;
  if (part) {
    part->number = *number;
  }
  return part;
}

}  // namespace

bool is_object_section(SectionKind kind) { return has_form(kind, NameForm::object); }

bool is_module_section(SectionKind kind) {
  return has_form(kind, NameForm::module) || has_form(kind, NameForm::module_index) ||
         has_form(kind, NameForm::module_object);
}

bool is_object_list(SectionKind kind) {
  return kind == SectionKind::mandatory_objects || kind == SectionKind::optional_objects ||
         kind == SectionKind::manufacturer_objects;
}

bool is_known(SectionKind kind) { return find_section(kind) != nullptr; }

bool is_single(SectionKind kind) { return has_form(kind, NameForm::title); }

SectionName read_section_name(std::string_view name, SubIndexNotation notation) {
  if (const std::optional<SectionName> object = read_object(name, notation)) {
    return *object;
  }
  if (const std::optional<SectionKind> kind = find_title(NameForm::title, name)) return {.kind = *kind};
  return read_numbered(name, notation).value_or(SectionName{});
}

std::string spell_section_name(const SectionName& name) {
  const SectionRow* const row = find_section(name.kind);
  if (row == nullptr) return {};
  const auto spell_object = [&](SectionKind kind) {
    const std::string sub_index = kind == SectionKind::sub_object ? fmt::format("{:X}", name.sub_index) : "";
    return fmt::format("{:04X}{}{}", name.index, title_of(kind), sub_index);
  };
  switch (row->form) {
    case NameForm::title: break;
    case NameForm::tool: return fmt::format("{}{}", row->title, name.number);
    case NameForm::object: return spell_object(name.kind);
    case NameForm::module: return fmt::format("{}{}{}", module_prefix, name.number, row->title);
    case NameForm::module_index: return fmt::format("{}{}{}{:04X}", module_prefix, name.number, row->title, name.index);
    case NameForm::module_object:
      return fmt::format("{}{}{}{}", module_prefix, name.number, row->title, spell_object(name.part));
  }
  return std::string{row->title};
}

std::uint64_t identity(const SectionName& name) {
  std::uint64_t bits = name.number;
  bits = (bits << 8U) | place_of_section(name.kind);
  bits = (bits << 16U) | name.index;
  bits = (bits << 8U) | place_of_section(name.part);
  return (bits << 8U) | name.sub_index;
}

std::string_view section_title(SectionKind kind) {
  const SectionRow* const row = find_section(kind);
  return row != nullptr ? row->title : std::string_view{};
}

std::vector<std::string> known_section_names(std::string_view like) {
  std::vector<std::string> names;
  const std::string_view digits = like.substr(0, std::min(like.size(), index_digits));
  const bool has_index = parse_hex(digits, index_digits).has_value();
  for (const SectionRow& row : section_rows) {
    if (row.form == NameForm::title) names.emplace_back(row.title);
    const bool is_entry = row.kind == SectionKind::object || row.kind == SectionKind::sub_object;
    if (has_index && row.form == NameForm::object && !is_entry) names.push_back(std::string{digits}.append(row.title));
  }
  for (const OtherTitle& other : other_titles) names.emplace_back(other.title);
  return names;
}

}  // namespace edsc
