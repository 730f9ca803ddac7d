#include "lint/rule_context.hpp"

#include <utility>

namespace edsc {

void RuleContext::report(AnyRule rule, const Position& position, std::string message, std::vector<Note> notes,
                         std::string cause) const {
  diagnostics.usual(rule, position, std::move(message), std::move(notes), std::move(cause));
}

const EntryDescription* RuleContext::describe(const Entry& entry) const {
  const ObjectDescription* object = sheet.find(entry.index);
  if (object == nullptr) return nullptr;
  const SubObjectDescription* sub_object = object->find(entry.sub_index);
  return sub_object != nullptr ? sub_object : static_cast<const EntryDescription*>(object);
}

std::string_view RuleContext::value_word(const Entry& entry) const {
  const EntryDescription* const description = describe(entry);
  const bool is_configured = sheet.is_dcf && description != nullptr && !description->parameter_value.empty();
  return is_configured ? "ParameterValue" : "default value";
}

Position RuleContext::place_of(const Entry& entry, Field EntryDescription::*key) const {
  const EntryDescription* description = describe(entry);
  if (description == nullptr || !(description->*key).present) return entry.position;
  return (description->*key).position;
}

}  // namespace edsc
