#include "backend/identifiers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <map>

#include "device/uniform_array.hpp"
#include "system/path.hpp"
#include "text/snake_case.hpp"
#include "text/source_file.hpp"

namespace edsc {
namespace {

/// From the name in the options, else from ParameterName, else from the index. A name in the options that C++ reserves
/// ends with an underscore, which is ignored.
std::string identifier(const Options& options, std::string_view name, std::uint16_t index, std::uint8_t sub_index) {
  if (const auto at = options.names.find({index, sub_index}); at != options.names.end()) {
    return to_snake_case(at->second);
  }
  std::string made = to_snake_case(name);
  if (made.empty()) made = sub_index == 0 ? fmt::format("object_{:04x}", index) : fmt::format("sub_{:02x}", sub_index);
  return made;
}

/// The name of an element without its number: "field" for "Field 1", "Field1" and, for sub-index 0Ah, "Field A".
std::string without_number(const Entry& element) {
  const std::string name = to_snake_case(element.parameter_name());
  const std::string hexadecimal = fmt::format("{:x}", element.sub_index);
  std::string rest;
  for (std::size_t begin = 0; begin < name.size();) {
    const std::size_t end = std::min(name.find('_', begin), name.size());
    std::string word = name.substr(begin, end - begin);
    begin = end + 1;
    if (word == hexadecimal || word == "0" + hexadecimal) continue;
    std::erase_if(word, [](char c) { return c >= '0' && c <= '9'; });
    if (!word.empty()) rest += (rest.empty() ? "" : "_") + word;
  }
  return rest;
}

/// Whether a name differs from those of the object and of the other elements by more than a number. `names`: the number
/// of elements by name without number.
bool has_own_name(const Object& object, const Entry& element, const std::map<std::string, int>& names) {
  const std::string name = without_number(element);
  if (name.empty() || name == to_snake_case(object.parameter_name())) return false;
  if (object.entries.size() == 2) return name == to_snake_case(element.parameter_name());
  return names.at(name) == 1;
}

std::string name_of_file(const Device& device) {
  std::string name = to_snake_case(stem_of(device.source->name()));
  return name.empty() ? "device" : name;
}

}  // namespace

std::string IdentifierScope::take(const std::string& wanted, std::string_view suffix) {
  if (taken_.insert(wanted).second) return wanted;
  std::string base = wanted;
  if (base.back() != '_') base += '_';
  base += suffix;
  std::string candidate = base;
  for (int i = 2; !taken_.insert(candidate).second; ++i) candidate = base + "_" + std::to_string(i);
  return candidate;
}

Identifiers::Identifiers(const Device& device, const Options& options, std::string_view device_name)
    : device_{device_name.empty() ? name_of_file(device) : std::string{device_name}} {
  IdentifierScope scope;
  for (const Object& object : device.objects) {
    const std::string& name = objects_[object.index] =
        scope.take(identifier(options, object.parameter_name(), object.index, 0), fmt::format("{:04x}", object.index));
    if (object.has_sub_indices()) {
      name_entries(object, options);
    } else {
      entries_[key_of(object.entries.front())] = name;
      vars_.insert(object.index);
    }
  }
  for (const Object& object : device.objects) {
    if (describes_uniform_array(object)) name_elements(object, options, scope);
  }
}

std::string Identifiers::full(const Entry& entry) const {
  const std::string& object = objects_.at(entry.index);
  if (vars_.contains(entry.index)) return object;
  if (const std::string* const own = element(entry)) return *own;
  if (uniform_arrays_.contains(entry.index)) return fmt::format("{}_{}", object, entry.sub_index);
  return object + "_" + of(entry);
}

const std::string* Identifiers::element(const Entry& entry) const {
  const auto at = elements_.find(key_of(entry));
  return at == elements_.end() ? nullptr : &at->second;
}

void Identifiers::name_entries(const Object& object, const Options& options) {
  IdentifierScope scope;
  for (const Entry& entry : object.entries) {
    // The options name the object by its sub-index 0.
    std::string name = entry.sub_index != 0 ? identifier(options, entry.parameter_name(), entry.index, entry.sub_index)
                                            : to_snake_case(entry.parameter_name());
    const bool is_of_object = entry.sub_index == 0 && entry.parameter_name() == object.parameter_name();
    if (name.empty() || is_of_object) name = "highest_sub_index_supported";
    entries_[key_of(entry)] = scope.take(name, fmt::format("{:02x}", entry.sub_index));
  }
}

void Identifiers::name_elements(const Object& object, const Options& options, IdentifierScope& of_device) {
  uniform_arrays_.insert(object.index);
  std::map<std::string, int> names;
  for (const Entry& entry : object.entries) {
    if (entry.sub_index != 0) ++names[without_number(entry)];
  }
  const std::string prefix = of(object) + "_";
  for (const Entry& entry : object.entries) {
    const bool is_named = options.names.contains({entry.index, entry.sub_index});
    if (entry.sub_index == 0 || !(is_named || has_own_name(object, entry, names))) continue;
    const std::string& name = of(entry);
    elements_[key_of(entry)] = of_device.take(name.starts_with(prefix) ? name : prefix + name,
                                              fmt::format("{:04x}_{:02x}", entry.index, entry.sub_index));
  }
}

}  // namespace edsc
