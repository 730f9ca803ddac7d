#include "device/objects/compact_sub_objects.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "device/limits.hpp"
#include "diagnostics/quote.hpp"
#include "eds/number.hpp"

namespace edsc {
namespace {

Field text_field(std::string text, const Position& position, std::deque<std::string>& texts) {
  return {texts.emplace_back(std::move(text)), position, true};
}

/// Sub-index 0 of a compact object: NrOfObjects, UNSIGNED8, read only.
SubObjectDescription count_description(const ObjectDescription& description, std::uint8_t count,
                                       std::deque<std::string>& texts) {
  SubObjectDescription sub;
  const Position& place = description.compact_sub_obj.position;
  sub.position = description.position;
  sub.parameter_name = {"NrOfObjects", place, true};
  sub.data_type = {"0x0005", place, true};
  sub.access_type = {"ro", place, true};
  sub.default_value = text_field(fmt::format("{}", count), place, texts);
  return sub;
}

/// Sub-indices 1.. have the keys of the object, and its name followed by their number.
SubObjectDescription element_description(const ObjectDescription& description, std::uint8_t sub_index,
                                         std::deque<std::string>& texts) {
  SubObjectDescription sub;
  const EntryDescription& keys = description;
  static_cast<EntryDescription&>(sub) = keys;
  sub.sub_index = sub_index;
  sub.object_type = {};
  sub.denotation = {};
  sub.parameter_name = text_field(fmt::format("{}{}", description.parameter_name.text, sub_index),
                                  description.parameter_name.position, texts);
  return sub;
}

/// `subs` is ascending.
SubObjectDescription* find_sub(std::vector<SubObjectDescription>& subs, std::uint32_t sub_index) {
  const auto at = std::ranges::lower_bound(subs, sub_index, {}, &SubObjectDescription::sub_index);
  return at != subs.end() && at->sub_index == sub_index ? &*at : nullptr;
}

/// Sets the texts of a list in their sub-objects.
void apply_list(const std::vector<NumberedField>& list, Field EntryDescription::*key,
                std::vector<SubObjectDescription>& subs, Diagnostics& diagnostics) {
  for (const NumberedField& entry : list) {
    if (SubObjectDescription* sub = find_sub(subs, entry.number)) {
      sub->*key = entry.field;
    } else {
      diagnostics.warning(
          "compact-entry", entry.field.position,
          fmt::format("sub-index {}, for which {} is given, does not exist", entry.number, quote(entry.field.text)));
    }
  }
}

}  // namespace

std::uint8_t compact_count(const ObjectDescription& description, Diagnostics& diagnostics) {
  const Field& field = description.compact_sub_obj;
  const std::string_view text = strip_inline_comment(field.text);
  if (text.empty()) return 0;
  const auto count = parse_unsigned(text);
  if (!count) {
    diagnostics.error("compact-sub-obj", field.position, fmt::format("CompactSubObj {} is not a number", quote(text)));
    return 0;
  }
  if (*count > max_sub_objects) {
    diagnostics.warning("compact-sub-obj", field.position, "the maximum of CompactSubObj is 254; using 254");
  }
  return static_cast<std::uint8_t>(std::min<std::uint64_t>(*count, max_sub_objects));
}

bool has_compact_form(const ObjectDescription& description) {
  return !description.compact_sub_obj.empty() || !description.compact_names.empty() ||
         !description.compact_values.empty() || !description.compact_denotations.empty();
}

std::vector<SubObjectDescription> unfold_sub_objects(const ObjectDescription& description, bool is_dcf,
                                                     std::deque<std::string>& texts, Diagnostics& diagnostics) {
  std::vector<SubObjectDescription> subs = description.sub_objects;
  if (const std::uint8_t count = compact_count(description, diagnostics); count > 0) {
    subs.clear();
    subs.reserve(count + 1U);
    subs.push_back(count_description(description, count, texts));
    for (unsigned i = 1; i <= count; ++i) {
      subs.push_back(element_description(description, static_cast<std::uint8_t>(i), texts));
    }
    for (const SubObjectDescription& own : description.sub_objects) {
      if (SubObjectDescription* sub = find_sub(subs, own.sub_index)) {
        *sub = own;
      } else {
        subs.push_back(own);  // beyond the compact ones; still ascending
      }
    }
  }
  apply_list(description.compact_names, &EntryDescription::parameter_name, subs, diagnostics);
  apply_list(description.compact_values, is_dcf ? &EntryDescription::parameter_value : &EntryDescription::default_value,
             subs, diagnostics);
  apply_list(description.compact_denotations, &EntryDescription::denotation, subs, diagnostics);
  return subs;
}

}  // namespace edsc
