#include <fmt/format.h>

#include <string_view>
#include <unordered_map>

#include "backend/cpp/identifier.hpp"
#include "device/objects/standard_objects.hpp"
#include "lint/rule_groups.hpp"
#include "text/ascii.hpp"

namespace edsc {
namespace {

/// An object of the device, or an entry of an object.
struct Named {
  std::string label;
  const std::string& name;
  std::string identifier;
  Position position;
};

/// The first use of each name in one scope. Filled when the first changed name is found.
class Scope {
 public:
  [[nodiscard]] bool filled() const { return !first_.empty(); }
  void add(std::string_view identifier, Position position, std::string label) {
    first_.try_emplace(std::string{identifier}, std::make_pair(position, std::move(label)));
  }
  [[nodiscard]] const std::pair<Position, std::string>* find(const std::string& identifier) const {
    const auto at = first_.find(identifier);
    return at == first_.end() ? nullptr : &at->second;
  }

 private:
  std::unordered_map<std::string, std::pair<Position, std::string>> first_;
};

/// Whether the identifier may differ from the one that its name gives: a cheap check with false positives.
bool may_be_changed(std::string_view identifier) {
  if (identifier.empty() || identifier.back() == '_' || identifier.starts_with("n_")) return true;
  if (identifier.starts_with("object_") || identifier.starts_with("sub_")) return true;
  const std::size_t suffix = identifier.rfind('_');
  if (suffix == std::string_view::npos) return false;
  for (const char c : identifier.substr(suffix + 1)) {
    if (!is_hex_digit(c)) return false;
  }
  return true;
}

/// `fill` adds all names of the scope, including changed ones.
template <typename Fill>
void check_name(const RuleContext& context, const Named& named, Scope& scope, Fill fill) {
  if (named.name.empty() || !may_be_changed(named.identifier)) return;
  const std::string wanted = to_cpp_identifier(named.name);
  if (wanted.empty()) {
    context.report("name-empty", named.position,
                   fmt::format("{} \"{}\" has no character that a C++ name can contain; using {}", named.label,
                               named.name, named.identifier));
    return;
  }
  if (wanted != named.identifier) {
    if (!scope.filled()) fill(scope);
    const auto* first = scope.find(wanted);
    std::vector<Note> notes;
    if (first != nullptr) notes.push_back({first->first, fmt::format("{} has this name", first->second)});
    context.report("name-twice", named.position,
                   fmt::format("{} \"{}\" would be {} in C++, which is already used; using {}", named.label, named.name,
                               wanted, named.identifier),
                   std::move(notes), "name");
  } else if (wanted.back() == '_') {
    context.report(
        "name-reserved", named.position,
        fmt::format("{} \"{}\" is reserved in C++ or in the generated code; using {}", named.label, named.name, wanted),
        {}, "name");
  } else if (wanted.starts_with("n_") && is_digit(wanted[2])) {
    context.report("name-digit", named.position,
                   fmt::format("{} \"{}\" begins with a digit; using {}", named.label, named.name, wanted), {}, "name");
  }
}

bool named_by_options(const RuleContext& context, std::uint16_t index, std::uint8_t sub_index) {
  return context.options.names.contains({index, sub_index});
}

Position name_place(const EntryDescription* description, const Position& section) {
  return description != nullptr && description->parameter_name.present ? description->parameter_name.position : section;
}

/// CiA 301 defines the same name for all PDO parameters, and for all SDO parameters.
bool is_one_of_many(std::uint16_t index) {
  const StandardObject* standard = find_standard_object(index);
  return standard != nullptr && standard->first != standard->last;
}

/// The elements of an ARRAY are identified by their numbers.
void check_entry_names(const RuleContext& context, const Object& object, const CppNames& names) {
  Scope scope;
  const auto fill = [&](Scope& all) {
    for (const Entry& entry : object.entries) {
      all.add(names.of(entry), context.place_of(entry, &EntryDescription::parameter_name),
              entry_label(entry.index, entry.sub_index));
    }
  };
  for (const Entry& entry : object.entries) {
    const bool count_without_name = entry.sub_index == 0 && entry.name == object.name;
    if (!may_be_changed(names.of(entry)) || count_without_name) continue;
    if (named_by_options(context, entry.index, entry.sub_index)) continue;
    const Position place = context.place_of(entry, &EntryDescription::parameter_name);
    check_name(context, {entry_label(entry.index, entry.sub_index), entry.name, names.of(entry), place}, scope, fill);
  }
}

}  // namespace

void check_names(const RuleContext& context, const CppNames& names) {
  Scope scope;
  const auto fill = [&](Scope& all) {
    for (const Object& object : context.device.objects) {
      all.add(names.of(object), name_place(context.sheet.find(object.index), object.position),
              index_label(object.index));
    }
  };
  for (const Object& object : context.device.objects) {
    if (is_one_of_many(object.index)) continue;
    if (may_be_changed(names.of(object)) && !named_by_options(context, object.index, 0)) {
      const Position place = name_place(context.sheet.find(object.index), object.position);
      check_name(context, {index_label(object.index), object.name, names.of(object), place}, scope, fill);
    }
    if (object.type == ObjectType::record) check_entry_names(context, object, names);
  }
}

}  // namespace edsc
