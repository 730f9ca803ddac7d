#include "backend/cpp/views.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "backend/cpp/cpp_text.hpp"
#include "backend/cpp/json_object.hpp"

namespace edsc {
namespace {

using nlohmann::ordered_json;

template <class Rows, class View>
ordered_json views_of(const Rows& rows, View view) {
  ordered_json views = json_array(rows.size());
  for (const auto& row : rows) views.push_back(view(row));
  return views;
}

// ---- structs ----

std::string array_initializer(const Object& object) {
  std::string list;
  bool zero = true;
  for (const Entry& entry : object.entries) {
    if (entry.sub_index == 0) continue;
    list.append(list.empty() ? "" : ", ").append(cpp_initializer(entry));
    zero = zero && is_zero(entry);
  }
  return zero ? "{}" : "{{" + list + "}}";
}

std::string initializer(const Member& member) {
  if (member.entry != nullptr) return cpp_initializer(*member.entry);
  if (member.parts.empty()) return array_initializer(*member.object);
  std::string list;
  for (const Member& part : member.parts) {
    list += fmt::format("{}.{} = {}", list.empty() ? "" : ", ", part.name, initializer(part));
  }
  return "{" + list + "}";
}

std::string comment(const Member& member) {
  if (member.entry != nullptr) {
    return fmt::format("{}  {}", entry_label(member.entry->index, member.entry->sub_index),
                       cpp_comment(member.entry->name));
  }
  const std::string range =
      member.parts.empty() ? fmt::format(":01..{:02X}", member.object->entries.size() - 1) : std::string{};
  return fmt::format("{}{}  {}", index_label(member.object->index), range, cpp_comment(member.object->name));
}

std::string declaration(const Member& member) { return fmt::format("{} {};", member.type, member.name); }

/// A member of a record type: its values and comments are those of the records.
ordered_json plain_member_view(const Member& member) {
  return json_object("declaration", declaration(member), "name", member.name, "initializer", "");
}

ordered_json member_view(const Member& member) {
  std::string text = declaration(member);
  const std::string gap(text.size() < 63 ? 64 - text.size() : 1, ' ');
  std::string remark = fmt::format("{}///< {}", gap, comment(member));
  return json_object("declaration", std::move(text), "name", member.name, "initializer", initializer(member), "remark",
                     std::move(remark));
}

template <class View>
ordered_json struct_view(const Struct& s, View view) {
  return json_object("type", s.type, "name", s.name, "comment", cpp_comment(s.comment), "members",
                     views_of(s.members, view));
}

ordered_json record_type_view(const Struct& s) { return struct_view(s, plain_member_view); }

/// A part of Values.
ordered_json section_view(const Struct& s) {
  ordered_json view = struct_view(s, member_view);
  view["preset"] = s.preset;
  view["communication"] = s.communication;
  return view;
}

// ---- tables ----

ordered_json row_view(std::string text, std::string_view remark = {}) {
  return json_object("text", std::move(text), "remark", remark.empty() ? "" : "  // " + cpp_comment(remark));
}

/// A table for the template: its rows, and whether there are any.
template <class Rows, class View>
ordered_json table_view(const Rows& rows, View view) {
  return json_object("any", !rows.empty(), "rows", views_of(rows, view));
}

std::string offset_text(const Location& location) {
  return location.type.empty() ? "0" : fmt::format("offsetof({}, {})", location.type, location.member);
}

std::string place_text(const Word& word) {
  if (word.place == MemoryPlace::ram || word.place == MemoryPlace::rom) {
    const std::string_view place = word.place == MemoryPlace::ram ? "ram" : "rom";
    return word.location.type.empty() ? std::string{place} : fmt::format("{} | {}", place, offset_text(word.location));
  }
  const std::string_view place = word.place == MemoryPlace::immediate ? "immediate" : "immediate_plus_node_id";
  return word.hexadecimal ? fmt::format("{} | 0x{:X}", place, word.number) : fmt::format("{} | {}", place, word.number);
}

std::string word_text(const Word& word) {
  return fmt::format("{} | {} | {}{}{}{}", place_text(word), word.type, word.access, word.tpdo ? " | tpdo" : "",
                     word.rpdo ? " | rpdo" : "", word.limited ? " | limited" : "");
}

ordered_json run_view(const RunRow& row) { return row_view(fmt::format("{{0x{:04X}, {}}}", row.first, row.position)); }

ordered_json entry_view(const EntryRow& row) {
  if (row.word) return row_view(word_text(*row.word), entry_label(row.object->index, 0));
  return row_view(
      fmt::format("{} | shape({}) | {}", row.is_array ? "array" : "record", row.shape, offset_text(row.location)),
      fmt::format("{}  {}", index_label(row.object->index), row.object->name));
}

ordered_json shape_view(const ShapeRow& row) {
  return row_view(fmt::format("{{.subs = {}, .highest = {}, .stride = {}}}", row.subs, row.highest, row.stride),
                  index_label(row.object->index));
}

ordered_json sub_view(const SubRow& row) {
  return row_view(row.word ? word_text(*row.word) : "gap",
                  row.first_of != nullptr ? index_label(row.first_of->index) : "");
}

ordered_json limit_view(const LimitRow& row) {
  const Entry& entry = *row.entry;
  const std::string key = fmt::format("canopen::object_key(0x{:04X}, 0x{:02X})", entry.index, entry.sub_index);
  if (entry.type->kind == canopen::DataClass::string) {
    return row_view(fmt::format("{{{}, {}, {}}}", key, row.low, row.high), entry.name);
  }
  const auto text = [&](const std::optional<Value>& limit) { return limit ? cpp_literal(*limit, *entry.type) : ""; };
  return row_view(fmt::format("{{{}, 0x{:X}, 0x{:X}}}", key, row.low, row.high),
                  fmt::format("{}..{}", text(entry.low_limit), text(entry.high_limit)));
}

ordered_json accepted_view(const AcceptedRow& row) {
  return row_view(fmt::format("{{0x{:04X}, {{{}, {}}}}}", row.entry->index, row.values.low, row.values.high));
}

ordered_json node_id_view(const NodeIdRow& row) {
  std::string offset = offset_text(row.location);
  if (row.offset) offset += fmt::format(" + {}", *row.offset);
  return row_view(fmt::format("{{{}, {}}}", offset, stride(*row.entry)),
                  entry_label(row.entry->index, row.entry->sub_index));
}

}  // namespace

ordered_json layout_view(const MemoryLayout& layout) {
  return json_object("record_types", views_of(layout.record_types, record_type_view), "values",
                     views_of(layout.values, section_view), "any_values", !layout.values.empty(), "constants",
                     struct_view(layout.constants, member_view), "any_constants", !layout.constants.members.empty(),
                     "runs", table_view(layout.runs, run_view), "entries", table_view(layout.entries, entry_view),
                     "shapes", table_view(layout.shapes, shape_view), "subs", table_view(layout.subs, sub_view),
                     "limits", table_view(layout.limits, limit_view), "wide_limits",
                     table_view(layout.wide_limits, limit_view), "accepted", table_view(layout.accepted, accepted_view),
                     "node_id_relative_communication", table_view(layout.node_id_relative_communication, node_id_view),
                     "node_id_relative_application", table_view(layout.node_id_relative_application, node_id_view),
                     "longest_download", layout.longest_download);
}

}  // namespace edsc
