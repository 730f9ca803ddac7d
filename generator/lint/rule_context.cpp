#include "lint/rule_context.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace edsc {

void RuleContext::report(AnyRule rule, const Position& position, std::string message, std::vector<Note> notes,
                         std::string cause) const {
  diagnostics.usual(rule, position, std::move(message), std::move(notes), std::move(cause));
}

const ObjectDescription* RuleContext::describe(std::uint16_t index) const {
  const auto at = std::lower_bound(sheet.objects.begin(), sheet.objects.end(), index,
                                   [](const ObjectDescription& object, std::uint16_t i) { return object.index < i; });
  return at != sheet.objects.end() && at->index == index ? &*at : nullptr;
}

const EntryDescription* RuleContext::describe(const Entry& entry) const {
  const ObjectDescription* object = describe(entry.index);
  if (object == nullptr) return nullptr;
  for (const SubObjectDescription& sub_object : object->sub_objects) {
    if (sub_object.sub_index == entry.sub_index) return &sub_object;
  }
  return object;
}

Position RuleContext::place_of(const Entry& entry, Field EntryDescription::*key) const {
  const EntryDescription* description = describe(entry);
  if (description == nullptr || !(description->*key).present) return entry.position;
  return (description->*key).position;
}

Position default_place(const Entry& entry) {
  return entry.default_value ? entry.default_value->position : entry.position;
}

std::string named(const Entry& entry) {
  return fmt::format("{} \"{}\"", entry_label(entry.index, entry.sub_index), entry.name);
}

std::string named(const Object& object) { return fmt::format("{} \"{}\"", index_label(object.index), object.name); }

}  // namespace edsc
