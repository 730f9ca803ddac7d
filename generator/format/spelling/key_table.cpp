#include "format/spelling/key_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <span>

#include "eds/ini.hpp"
#include "eds/number.hpp"

namespace edsc {
namespace {

constexpr auto file_info = keys_of(file_info_keys);
constexpr auto device_info = keys_of(device_info_keys);
constexpr auto commissioning = keys_of(commissioning_keys);
constexpr auto object = all_object_keys();
constexpr auto sub_object = keys_of(entry_keys);

struct SectionRow {
  SectionKind kind;
  std::span<const SectionKey> keys;
};

constexpr SectionRow sections[] = {
    {SectionKind::file_info, file_info},
    {SectionKind::device_info, device_info},
    {SectionKind::dummy_usage, dummy_usage_keys},
    {SectionKind::comments, comments_keys},
    {SectionKind::device_commissioning, commissioning},
    {SectionKind::mandatory_objects, object_list_keys},
    {SectionKind::optional_objects, object_list_keys},
    {SectionKind::manufacturer_objects, object_list_keys},
    {SectionKind::object, object},
    {SectionKind::sub_object, sub_object},
    {SectionKind::compact_names, compact_text_keys},
    {SectionKind::compact_values, compact_value_keys},
    {SectionKind::compact_denotations, compact_text_keys},
    {SectionKind::object_links, object_links_keys},
};

std::span<const SectionKey> keys_in(SectionKind kind) {
  const auto* const row = std::ranges::find(sections, kind, &SectionRow::kind);
  return row != std::end(sections) ? row->keys : std::span<const SectionKey>{};
}

/// Reserved positions for the numbered keys of one row.
constexpr std::uint32_t row_step = 1U << 20U;
constexpr std::uint32_t unknown_order = std::numeric_limits<std::uint32_t>::max();

constexpr std::size_t dummy_digits = 4;

struct RowMatch {
  std::string name;
  std::uint32_t number = 0;
};

/// Whether a key matches the row.
std::optional<RowMatch> match(const SectionKey& row, std::string_view key) {
  if (!row.is_numbered()) {
    return equal_ignoring_case(row.name, key) ? std::optional{RowMatch{std::string{row.name}, 0}} : std::nullopt;
  }
  const std::string_view prefix = row.name.substr(0, row.name.size() - 1);
  if (!starts_with_ignoring_case(key, prefix)) return std::nullopt;
  const std::string_view digits = key.substr(prefix.size());
  if (row.name.ends_with('%')) {
    const auto index = digits.size() == dummy_digits ? parse_hex(digits, dummy_digits) : std::nullopt;
    return index ? std::optional{RowMatch{fmt::format("{}{:04X}", prefix, *index), *index}} : std::nullopt;
  }
  const auto number = parse_unsigned(digits);
  if (!number || *number >= row_step) return std::nullopt;
  return RowMatch{fmt::format("{}{}", prefix, *number), static_cast<std::uint32_t>(*number)};
}

}  // namespace

KeySpelling spell_key(SectionKind section, std::string_view key) {
  std::uint32_t order = 0;
  for (const SectionKey& row : keys_in(section)) {
    if (const auto found = match(row, key)) {
      return {order + found->number, found->name, row.value, row.hex_digits, found->number, true};
    }
    order += row_step;
  }
  return {unknown_order, std::string{key}, ValueKind::text, 1, 0, false};
}

std::string spell_title(const SectionName& name, std::string_view title) {
  if (keys_in(name.kind).empty()) return std::string{title};
  const std::string_view known = section_title(name.kind);
  if (!is_object_section(name.kind)) return std::string{known};
  if (name.kind == SectionKind::sub_object) return fmt::format("{:04X}{}{:X}", name.index, known, name.sub_index);
  return fmt::format("{:04X}{}", name.index, known);
}

}  // namespace edsc
