#include "eds/section_name.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>

#include "eds/number.hpp"
#include "text/ascii.hpp"
#include "text/ini.hpp"

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
};

/// What may follow the index of an object, other than `sub` and the sub-index.
struct IndexSuffix {
  std::string_view suffix;
  SectionKind kind;
  std::string_view remark;
};

constexpr IndexSuffix index_suffixes[] = {
    {"Name", SectionKind::compact_names, {}},
    {"Value", SectionKind::compact_values, {}},
    {"Denotation", SectionKind::compact_denotations, {}},
    {"ObjectLinks", SectionKind::not_used, "links between objects, for tools that show them"},
};

/// A `#` stands for one or more decimal digits, a `*` at the end for anything.
struct UnusedName {
  std::string_view pattern;
  std::string_view remark;
};

constexpr std::string_view modules = "modular devices are read without their modules";
constexpr std::string_view channels = "network variables of programmable devices are not supported";
constexpr std::string_view tools = "programs of the vendor";

constexpr UnusedName unused_names[] = {
    {"Tools", tools},
    {"Tool#", tools},
    {"DynamicChannels", channels},
    {"SupportedModules", modules},
    {"ConnectedModules", modules},
    {"M#ModuleInfo", modules},
    {"M#Comments", modules},
    {"M#Fixed*", modules},
    {"M#SubExt*", modules},
};

constexpr std::size_t index_digits = 4;
constexpr std::size_t sub_index_digits = 2;
constexpr std::string_view sub = "sub";

bool matches(std::string_view name, std::string_view pattern) {
  const std::size_t wildcard = std::min(pattern.find_first_of("#*"), pattern.size());
  if (!starts_with_ignoring_case(name, pattern.substr(0, wildcard))) {
    return false;
  }
  name.remove_prefix(wildcard);
  pattern.remove_prefix(wildcard);
  if (pattern.empty() || pattern[0] == '*') {
    return name.empty() || !pattern.empty();
  }
  const auto digits_end = std::find_if_not(name.begin(), name.end(), is_digit);
  const auto digits = static_cast<std::size_t>(digits_end - name.begin());
  return digits > 0 && matches(name.substr(digits), pattern.substr(1));
}

SectionName with_index(SectionKind kind, std::string_view digits, std::uint16_t index) {
  SectionName result;
  result.kind = kind;
  result.index = index;
  result.has_short_index = digits.size() < index_digits;
  return result;
}

SectionName malformed(std::string_view remark) {
  SectionName result;
  result.kind = SectionKind::malformed;
  result.remark = remark;
  return result;
}

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
  for (const IndexSuffix& row : index_suffixes) {
    const std::string_view index_text = name.substr(0, name.size() - std::min(name.size(), row.suffix.size()));
    const std::optional<std::uint16_t> index = parse_hex(index_text, index_digits);
    if (index && ends_with_ignoring_case(name, row.suffix)) {
      SectionName result = with_index(row.kind, index_text, *index);
      result.remark = row.remark;
      return result;
    }
  }
  return std::nullopt;
}

}  // namespace

SectionName read_section_name(std::string_view name) {
  if (const std::optional<SectionName> object = read_object(name)) {
    return *object;
  }
  SectionName result;
  for (const FixedName& row : fixed_names) {
    if (equal_ignoring_case(name, row.name)) {
      result.kind = row.kind;
      return result;
    }
  }
  for (const UnusedName& row : unused_names) {
    if (matches(name, row.pattern)) {
      result.kind = SectionKind::not_used;
      result.remark = row.remark;
      return result;
    }
  }
  return result;
}

}  // namespace edsc
