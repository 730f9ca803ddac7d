#include "eds/sections/section_name.hpp"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <optional>
#include <span>

#include "eds/ini.hpp"
#include "eds/number.hpp"
#include "text/ascii.hpp"

namespace edsc {
namespace {

struct FixedName {
  std::string_view name;
  SectionKind kind;
};

constexpr FixedName fixed_names[] = {
    {"FileInfo", SectionKind::file_info},
    {"DeviceInfo", SectionKind::device_info},
    {"DummyUsage", SectionKind::dummy_usage},
    {"Comments", SectionKind::comments},
    {"DeviceComissioning", SectionKind::device_commissioning},
    {"DeviceCommissioning", SectionKind::device_commissioning},
    {"MandatoryObjects", SectionKind::mandatory_objects},
    {"OptionalObjects", SectionKind::optional_objects},
    {"ManufacturerObjects", SectionKind::manufacturer_objects},
    {"Tools", SectionKind::tools},
    {"DynamicChannels", SectionKind::dynamic_channels},
    {"SupportedModules", SectionKind::supported_modules},
    {"ConnectedModules", SectionKind::connected_modules},
};

/// What may follow the index of an object, other than `sub` and the sub-index.
constexpr FixedName index_suffixes[] = {
    {"Name", SectionKind::compact_names},
    {"Value", SectionKind::compact_values},
    {"Denotation", SectionKind::compact_denotations},
    {"ObjectLinks", SectionKind::object_links},
};

/// What follows `M` and the number of a module.
constexpr FixedName module_parts[] = {
    {"ModuleInfo", SectionKind::module_info},
    {"Comments", SectionKind::module_comments},
    {"FixedObjects", SectionKind::module_fixed_objects},
    {"SubExtends", SectionKind::module_sub_extends},
};

constexpr std::string_view tool_prefix = "Tool";
constexpr std::string_view module_prefix = "M";
constexpr std::string_view fixed_prefix = "Fixed";
constexpr std::string_view extension_prefix = "SubExt";
constexpr std::size_t number_digits = 4;

constexpr std::size_t index_digits = 4;
constexpr std::size_t sub_index_digits = 2;
constexpr std::string_view sub = "sub";

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

std::optional<SectionKind> find_fixed(std::span<const FixedName> table, std::string_view name) {
  for (const FixedName& row : table) {
    if (equal_ignoring_case(name, row.name)) {
      return row.kind;
    }
  }
  return std::nullopt;
}

SectionName with_index(SectionKind kind, std::string_view digits, std::uint16_t index) {
  return {.kind = kind, .index = index, .has_short_index = digits.size() < index_digits};
}

SectionName malformed(std::string_view remark) { return {.kind = SectionKind::malformed, .remark = remark}; }

/// `HHHHsubHH`.
SectionName read_sub_object(std::string_view index_text, std::uint16_t index, std::string_view sub_index_text) {
  const std::optional<std::uint16_t> sub_index = parse_hex(sub_index_text, sub_index_digits);
  if (!sub_index) {
    return malformed("a sub-index has one or two hexadecimal digits, FFh at most");
  }
  SectionName result = with_index(SectionKind::sub_object, index_text, index);
  result.sub_index = static_cast<std::uint8_t>(*sub_index);
  return result;
}

/// Names that begin with an index.
std::optional<SectionName> read_object(std::string_view name) {
  if (const std::optional<std::uint16_t> index = parse_hex(name, index_digits)) {
    return with_index(SectionKind::object, name, *index);
  }
  const auto digits_end = std::find_if_not(name.begin(), name.end(), is_hex_digit);
  const auto digits = static_cast<std::size_t>(digits_end - name.begin());
  const std::string_view rest = name.substr(digits);
  if (digits > 0 && (rest.empty() || starts_with_ignoring_case(rest, sub))) {
    const std::string_view index_text = name.substr(0, digits);
    const std::optional<std::uint16_t> index = parse_hex(index_text, index_digits);
    return index ? read_sub_object(index_text, *index, rest.substr(sub.size()))
                 : malformed("an index has four hexadecimal digits");
  }
  for (const FixedName& row : index_suffixes) {
    const std::string_view index_text = name.substr(0, name.size() - std::min(name.size(), row.name.size()));
    const std::optional<std::uint16_t> index = parse_hex(index_text, index_digits);
    if (index && ends_with_ignoring_case(name, row.name)) {
      return with_index(row.kind, index_text, *index);
    }
  }
  return std::nullopt;
}

/// The part after the module number.
std::optional<SectionName> read_module_part(std::string_view rest) {
  if (const std::optional<SectionKind> kind = find_fixed(module_parts, rest)) return SectionName{.kind = *kind};
  if (take_prefix(rest, extension_prefix)) {
    const std::optional<std::uint16_t> index = parse_hex(rest, index_digits);
    return index ? with_index(SectionKind::module_sub_extension, rest, *index)
                 : malformed("an index has four hexadecimal digits");
  }
  if (take_prefix(rest, fixed_prefix)) {
    std::optional<SectionName> object = read_object(rest);
    if (object && object->kind != SectionKind::malformed) {
      object->part = object->kind;
      object->kind = SectionKind::module_fixed_object;
    }
    return object;
  }
  return std::nullopt;
}

/// `ToolX`, and names that begin with `MX`.
std::optional<SectionName> read_numbered(std::string_view name) {
  std::string_view rest = name;
  if (take_prefix(rest, tool_prefix)) {
    const std::optional<std::uint16_t> number = take_number(rest);
    if (!number || !rest.empty()) return std::nullopt;
    return SectionName{.kind = SectionKind::tool, .number = *number};
  }
  if (!take_prefix(rest, module_prefix)) {
    return std::nullopt;
  }
  const std::optional<std::uint16_t> number = take_number(rest);
  std::optional<SectionName> part = number ? read_module_part(rest) : std::nullopt;
  if (part) {
    part->number = *number;
  }
  return part;
}

}  // namespace

SectionName read_section_name(std::string_view name) {
  if (const std::optional<SectionName> object = read_object(name)) {
    return *object;
  }
  if (const std::optional<SectionKind> kind = find_fixed(fixed_names, name)) return {.kind = *kind};
  return read_numbered(name).value_or(SectionName{});
}

std::string_view section_title(SectionKind kind) {
  if (kind == SectionKind::sub_object) return sub;
  for (const std::span<const FixedName> table :
       {std::span<const FixedName>{fixed_names}, std::span<const FixedName>{index_suffixes}}) {
    const auto row = std::ranges::find(table, kind, &FixedName::kind);
    if (row != table.end()) return row->name;
  }
  return "";
}

std::vector<std::string> known_section_names(std::string_view like) {
  std::vector<std::string> names;
  for (const FixedName& row : fixed_names) names.emplace_back(row.name);
  const std::string_view digits = like.substr(0, std::min(like.size(), index_digits));
  if (parse_hex(digits, index_digits)) {
    for (const FixedName& row : index_suffixes) names.push_back(std::string{digits}.append(row.name));
  }
  return names;
}

}  // namespace edsc
