#include "backend/cpp/typed_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "backend/cpp/cpp_text.hpp"
#include "backend/cpp/identifier.hpp"
#include "backend/cpp/json_object.hpp"
#include "backend/cpp/profile_types.hpp"
#include "backend/cpp/word_view.hpp"
#include "device/uniform_array.hpp"

namespace edsc {
namespace {

using canopen::DataClass;
using nlohmann::ordered_json;

bool is_signed(const Entry& entry) { return entry.type->kind == DataClass::signed_integer; }

/// The meaning of an integer; null for other entries.
const Meaning* meaning_of(const Entry& entry) {
  return is_signed(entry) || entry.type->kind == DataClass::unsigned_integer ? entry.meaning.get() : nullptr;
}

/// A scale that the device can change is not a type.
bool has_quantity(const Meaning& meaning) {
  return meaning.quantity && meaning.quantity->unit != nullptr && meaning.quantity->stated_by.empty();
}

EntryKey key_of(const Entry& entry) { return {entry.index, entry.sub_index}; }

/// Whether an entry is an element of an ARRAY of equal elements that all have its meaning.
bool is_of_all_elements(const Object& object, const Entry& entry) {
  return entry.sub_index != 0 && describes_uniform_array(object) &&
         std::all_of(object.entries.begin() + 1, object.entries.end(),
                     [&](const Entry& other) { return other.meaning == entry.meaning; });
}

}  // namespace

bool is_closed_enumeration(const Entry& entry, const Options& options) {
  const Meaning* const meaning = options.typed_values ? meaning_of(entry) : nullptr;
  return meaning != nullptr && !has_quantity(*meaning) && meaning->values && meaning->values->closed;
}

TypedValues::TypedValues(const NamedDevice& named, const Options& options) {
  if (!options.typed_values) return;
  IdentifierScope scope;
  static_cast<void>(scope.take("to_text", ""));
  for (const Object& object : named.device.objects) {
    for (const Entry& entry : object.entries) add(named, object, entry, scope);
  }
  if (!definitions_.is_null()) definitions_ = json_object("rows", std::move(definitions_));
  if (!names_of_values_.is_null()) names_of_values_ = json_object("rows", std::move(names_of_values_));
}

void TypedValues::add(const NamedDevice& named, const Object& object, const Entry& entry, IdentifierScope& scope) {
  const Meaning* const meaning = meaning_of(entry);
  if (meaning == nullptr) return;
  const auto [known, is_new] = of_meanings_.try_emplace({meaning, entry.type});
  if (is_new) known->second = type_of(named, object, entry, scope);
  if (!known->second.type.empty()) types_.emplace(key_of(entry), known->second);
}

TypedValue TypedValues::type_of(const NamedDevice& named, const Object& object, const Entry& entry,
                                IdentifierScope& scope) {
  const Meaning* const meaning = entry.meaning.get();
  TypedValue value;
  if (has_quantity(*meaning)) {
    value.is_quantity = true;
    value.type = quantity_type(entry.type->cpp_type, *meaning->quantity);
    return value;
  }
  ordered_json enumeration, word;
  if (meaning->values) {
    value.values = &*meaning->values;
    enumeration = enumeration_view(entry);
    if (enumeration["values"].empty()) return {};
    for (const ordered_json& one : enumeration["values"]) value.enumerators.push_back(one["identifier"]);
  } else if (meaning->has_fields() && !is_signed(entry)) {
    word = word_view(entry, "");
    if (word["fields"].empty() && word["masked"].empty() && word["cases"].empty()) return {};
  } else {
    return {};
  }
  const std::string contents = contents_of_type(enumeration, word);
  const auto [known, is_new] = defined_.try_emplace(contents);
  if (is_new) {
    const bool is_element = is_of_all_elements(object, entry);
    const std::string name = is_element ? named.names.of(object) : named.names.identifiers().full(entry);
    const std::string identifier = scope.take(without_reserved_word(name), "_" + fmt::format("{:04x}", entry.index));
    known->second = identifier;
    ordered_json comment = ordered_json::array();
    comment.push_back(fmt::format("{}.  {}{}", cpp_comment(is_element ? object.name : entry.name),
                                  is_element ? index_label(entry.index) : entry_label(entry.index, entry.sub_index),
                                  comment_of(*meaning)));
    const std::string_view of_profile = find_profile_type(contents);
    ordered_json alias;
    if (!of_profile.empty()) {
      uses_profile_types_ = true;
      alias = json_object("identifier", identifier, "type", of_profile);
      enumeration = word = nullptr;
    } else if (!enumeration.is_null()) {
      enumeration["identifier"] = identifier;
    } else {
      word = word_view(entry, identifier);
      word["identifier"] = identifier;
    }
    if (names_of_values_.is_null()) names_of_values_ = ordered_json::array();
    if (alias.is_null()) add_names_of_values(names_of_values_, identifier, enumeration, word);
    definitions_.push_back(json_object("comment", std::move(comment), "alias", std::move(alias), "enumeration",
                                       std::move(enumeration), "word", std::move(word)));
  }
  value.type = "meaning::" + known->second;
  return value;
}

const TypedValue* TypedValues::find(const Entry& entry) const {
  const auto at = types_.find(key_of(entry));
  return at == types_.end() ? nullptr : &at->second;
}

bool TypedValues::is_uniform(const Object& object) const {
  const TypedValue* const first = find(object.entries[1]);
  for (std::size_t i = 2; i < object.entries.size(); ++i) {
    const TypedValue* const other = find(object.entries[i]);
    if ((first == nullptr) != (other == nullptr)) return false;
    if (first != nullptr && (first->type != other->type || first->is_closed() != other->is_closed())) return false;
  }
  return true;
}

std::string TypedValues::closed_objects(const NamedDevice& named) const {
  std::string list;
  for (const Object& object : named.device.objects) {
    const bool is_array = describes_uniform_array(object) && is_uniform(object);
    for (const Entry& entry : object.entries) {
      const TypedValue* const value = find(entry);
      if (value == nullptr || !value->is_closed() || (is_array && entry.sub_index > 1)) continue;
      const bool is_element = is_array && entry.sub_index == 1;
      list += fmt::format(
          "{}{}", list.empty() ? "" : ", ",
          is_element ? fmt::format("od::{}<>", named.names.of(object)) : named.names.type_of(object, entry).text());
    }
  }
  return list;
}

}  // namespace edsc
