#include "change/change.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <tuple>
#include <type_traits>

#include "eds/number.hpp"

namespace edsc {
namespace {

using Json = nlohmann::ordered_json;

template <class Change, class Type>
struct ChangeMember {
  std::string_view name;
  Type Change::*member;
  bool required = true;
};
template <class Change, class Type>
ChangeMember(std::string_view, Type Change::*) -> ChangeMember<Change, Type>;
template <class Change, class Type>
ChangeMember(std::string_view, Type Change::*, bool) -> ChangeMember<Change, Type>;

template <class Change, class... Members>
struct ChangeRow {
  std::string_view name;  ///< value of `do`
  std::tuple<Members...> members;
};
template <class Change, class... Types>
constexpr auto change_row(std::string_view name, ChangeMember<Change, Types>... members) {
  return ChangeRow<Change, ChangeMember<Change, Types>...>{name, {members...}};
}

constexpr std::string_view kind_member = "do";

/// The changes and their members in JSON.
constexpr std::tuple change_rows{
    change_row<SetValue>("set", ChangeMember{"section", &SetValue::section}, ChangeMember{"key", &SetValue::key},
                         ChangeMember{"value", &SetValue::value}),
    change_row<RemovePart>("remove", ChangeMember{"section", &RemovePart::section},
                           ChangeMember{"key", &RemovePart::key, false}),
    change_row<RenamePart>("rename", ChangeMember{"section", &RenamePart::section},
                           ChangeMember{"key", &RenamePart::key, false}, ChangeMember{"name", &RenamePart::name}),
    change_row<AddSections>("add", ChangeMember{"sections", &AddSections::sections}),
    change_row<MapPdo>("map", ChangeMember{"direction", &MapPdo::direction}, ChangeMember{"number", &MapPdo::number},
                       ChangeMember{"objects", &MapPdo::objects, false}, ChangeMember{"cob_id", &MapPdo::cob_id, false},
                       ChangeMember{"transmission_type", &MapPdo::transmission_type, false},
                       ChangeMember{"inhibit_time", &MapPdo::inhibit_time, false},
                       ChangeMember{"event_timer", &MapPdo::event_timer, false},
                       ChangeMember{"sync_start", &MapPdo::sync_start, false}),
    change_row<AllowFinding>("allow", ChangeMember{"section", &AllowFinding::section},
                             ChangeMember{"key", &AllowFinding::key, false}, ChangeMember{"rule", &AllowFinding::rule},
                             ChangeMember{"reason", &AllowFinding::reason}),
};

constexpr std::string_view direction_names[] = {"receive", "transmit"};
constexpr std::string_view section_member = "section";
constexpr std::string_view keys_member = "keys";

// Values as JSON; null without a value.

Json value_as_json(const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); }
Json value_as_json(PdoDirection direction) { return direction_names[static_cast<std::size_t>(direction)]; }
template <class Number>
requires std::is_unsigned_v<Number> Json value_as_json(Number number) { return number; }

Json value_as_json(const std::vector<MappingValue>& objects) {
  Json list = Json::array();
  for (const MappingValue& one : objects) list.push_back(fmt::format("{:08X}h", one.value()));
  return list;
}

Json value_as_json(const std::vector<NewSection>& sections) {
  Json list = Json::array();
  for (const NewSection& section : sections) {
    Json keys = Json::object();
    for (const auto& [key, value] : section.keys) keys[key] = value;
    list.push_back({{section_member, section.title}, {keys_member, std::move(keys)}});
  }
  return list;
}

template <class Type>
Json value_as_json(const std::optional<Type>& value) {
  return value ? value_as_json(*value) : Json(nullptr);
}

// Values from JSON. They return false for another type or range.

bool read_json(const nlohmann::json& json, std::string& text) {
  if (!json.is_string()) return false;
  text = json.get<std::string>();
  return true;
}

bool read_json(const nlohmann::json& json, PdoDirection& direction) {
  for (std::size_t i = 0; i < std::size(direction_names); ++i) {
    if (!json.is_string() || json.get<std::string>() != direction_names[i]) continue;
    direction = static_cast<PdoDirection>(i);
    return true;
  }
  return false;
}

template <class Number>
requires std::is_unsigned_v<Number>
bool read_json(const nlohmann::json& json, Number& number) {
  if (!json.is_number_integer()) return false;
  const auto value = json.get<std::int64_t>();
  if (value < 0 || value > std::numeric_limits<Number>::max()) return false;
  number = static_cast<Number>(value);
  return true;
}

bool read_json(const nlohmann::json& json, std::vector<MappingValue>& objects) {
  if (!json.is_array()) return false;
  for (const nlohmann::json& one : json) {
    const auto value = one.is_string() ? parse_h_suffix(one.get<std::string>()) : std::nullopt;
    if (!value || *value > UINT32_MAX) return false;
    objects.push_back(MappingValue::of(static_cast<std::uint32_t>(*value)));
  }
  return true;
}

bool read_json(const nlohmann::json& json, std::vector<NewSection>& sections) {
  if (!json.is_array()) return false;
  for (const nlohmann::json& one : json) {
    if (!one.is_object() || one.size() != 2) return false;
    const auto title = one.find(section_member);
    const auto keys = one.find(keys_member);
    if (title == one.end() || keys == one.end() || !title->is_string() || !keys->is_object()) return false;
    NewSection section{title->get<std::string>(), {}};
    for (const auto& [key, value] : keys->items()) {
      if (!value.is_string()) return false;
      section.keys.emplace_back(key, value.get<std::string>());
    }
    sections.push_back(std::move(section));
  }
  return true;
}

template <class Type>
bool read_json(const nlohmann::json& json, std::optional<Type>& value) {
  return read_json(json, value.emplace());
}

/// Calls `use` with each row.
template <class Use>
void for_each_row(Use use) {
  std::apply([&](const auto&... rows) { (use(rows), ...); }, change_rows);
}

template <class Change, class... Members>
std::optional<SheetChange> read_row(const nlohmann::json& value, const ChangeRow<Change, Members...>& row,
                                    std::string& problem) {
  Change change;
  std::size_t known = 1;
  const auto read = [&](const auto& member) {
    const auto found = value.find(member.name);
    if (found == value.end()) {
      if (member.required && problem.empty()) problem = fmt::format("missing member \"{}\"", member.name);
      return;
    }
    ++known;
    if (!read_json(*found, change.*(member.member)) && problem.empty()) {
      problem = fmt::format("invalid value of \"{}\": {}", member.name, found->dump());
    }
  };
  std::apply([&](const auto&... members) { (read(members), ...); }, row.members);
  if (problem.empty() && known != value.size()) problem = fmt::format("unknown member of a change \"{}\"", row.name);
  if (!problem.empty()) return std::nullopt;
  return change;
}

/// `2010h`, `2010h:01`; other titles as they are.
std::string part_text(std::string_view title) {
  const auto index = parse_hex(title.substr(0, 4), 4);
  if (!index || title.size() < 4) return fmt::format("[{}]", title);
  if (title.size() == 4) return fmt::format("{:04X}h", *index);
  const auto sub = title.size() > 7 ? parse_hex(title.substr(7), 2) : std::nullopt;
  return sub ? fmt::format("{:04X}h:{:02X}", *index, *sub) : fmt::format("[{}]", title);
}

struct ChangeTexts {
  std::string operator()(const SetValue& one) const {
    return fmt::format("set {} of {} to {}", one.key, part_text(one.section), one.value);
  }
  std::string operator()(const RemovePart& one) const {
    if (one.key.empty()) return fmt::format("remove {}", part_text(one.section));
    return fmt::format("remove {} of {}", one.key, part_text(one.section));
  }
  std::string operator()(const RenamePart& one) const {
    if (one.key.empty()) return fmt::format("rename {} to {}", part_text(one.section), part_text(one.name));
    return fmt::format("rename {} of {} to {}", one.key, part_text(one.section), one.name);
  }
  std::string operator()(const AddSections& one) const {
    if (one.sections.empty()) return "add nothing";
    const std::string first = part_text(one.sections.front().title);
    return one.sections.size() == 1 ? fmt::format("add {}", first)
                                    : fmt::format("add {} and {} more sections", first, one.sections.size() - 1);
  }
  std::string operator()(const MapPdo& one) const {
    const std::string pdo = fmt::format("{} {}", one.direction == PdoDirection::receive ? "RPDO" : "TPDO", one.number);
    if (!one.objects) return fmt::format("set {}", pdo);
    if (one.objects->empty()) return fmt::format("map nothing to {}", pdo);
    std::string objects;
    for (const MappingValue& object : *one.objects) {
      if (!objects.empty()) objects += ", ";
      objects += fmt::format("{:04X}h:{:02X}", object.index, object.sub_index);
    }
    return fmt::format("map {} to {}", objects, pdo);
  }
  std::string operator()(const AllowFinding& one) const {
    if (one.key.empty()) return fmt::format("allow {} in {}", one.rule, part_text(one.section));
    return fmt::format("allow {} at {} of {}", one.rule, one.key, part_text(one.section));
  }
};

}  // namespace

nlohmann::ordered_json change_as_json(const SheetChange& change) {
  Json json;
  std::visit(
      [&]<class Change>(const Change& one) {
        const auto write = [&]<class... Members>(const ChangeRow<Change, Members...>& row) {
          json[kind_member] = row.name;
          const auto add = [&](const auto& member) {
            Json value = value_as_json(one.*(member.member));
            if (value.is_null() && member.required) value = "";
            if (!value.is_null()) json[std::string{member.name}] = std::move(value);
          };
          std::apply([&](const auto&... members) { (add(members), ...); }, row.members);
        };
        for_each_row([&](const auto& row) {
          if constexpr (std::is_invocable_v<decltype(write), decltype(row)>) write(row);
        });
      },
      change);
  return json;
}

std::optional<SheetChange> read_change(const nlohmann::json& value, std::string& problem) {
  problem.clear();
  if (!value.is_object()) {
    problem = "a change is an object";
    return std::nullopt;
  }
  const auto kind = value.find(kind_member);
  std::optional<SheetChange> change;
  bool is_known = false;
  for_each_row([&](const auto& row) {
    if (is_known || kind == value.end() || !kind->is_string() || kind->template get<std::string>() != row.name) return;
    is_known = true;
    change = read_row(value, row, problem);
  });
  if (!is_known) problem = "missing or unknown \"do\": expected set, remove, rename, add, map or allow";
  return change;
}

std::string change_text(const SheetChange& change) { return std::visit(ChangeTexts{}, change); }

}  // namespace edsc
