#include "device/behaviour_script.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "device/behaviour_commands.hpp"
#include "device/entry_text.hpp"
#include "json/json_file.hpp"
#include "text/duration.hpp"
#include "text/printable.hpp"
#include "text/suggestion.hpp"
#include "values/nmt_text.hpp"

namespace edsc {
namespace {

using BehaviourJson = JsonFile::Json;

constexpr unsigned max_count = 1'000'000'000;

/// The text of a value: a string, a number or a Boolean.
std::string value_word(const BehaviourJson& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_boolean()) return value.get<bool>() ? "1" : "0";
  return value.is_number() ? value.dump() : std::string{};
}

canopen::NmtState state_named(std::string_view name, bool& is_known) {
  for (const canopen::NmtState state : {canopen::NmtState::initialisation, canopen::NmtState::pre_operational,
                                        canopen::NmtState::operational, canopen::NmtState::stopped}) {
    if (canopen::to_text(state) == name) return state;
  }
  is_known = false;
  return {};
}

class BehaviourReader {
 public:
  BehaviourReader(const SourceFile& source, EntryFinder& names, Diagnostics& diagnostics)
      : file_{source}, names_{names}, diagnostics_{diagnostics} {}

  BehaviourScript read() {
    for (const JsonFault& fault : file_.faults()) error(fault.position, fault.message);
    if (file_.is_valid()) read_members(file_.root(), script_members, *this);
    return std::move(script_);
  }

 private:
  using Json = BehaviourJson;

  /// A member of an object: its name, and the function that reads it. It returns what is wrong, if that belongs to the
  /// name of the member.
  template <class Into>
  struct Member {
    std::string_view name;
    std::string (*read)(BehaviourReader& reader, const Json& value, Into& into);
  };
  struct RuleParts {
    BehaviourRule rule;
    bool has_event = false;
    std::vector<const Json*> numbers;  ///< of the condition: they need the entry of the event
  };

  template <class Into, std::size_t count>
  void read_members(const Json& object, const Member<Into> (&members)[count], Into& into) {
    if (!object.is_object()) return error(file_.value_position(object), "expected an object: {...}");
    for (const auto& [name, value] : file_.members(object)) {
      if (name == "$schema") continue;
      const auto* const member = std::ranges::find(members, std::string_view{name}, &Member<Into>::name);
      std::string problem;
      if (member == std::end(members)) {
        std::vector<std::string_view> all;
        for (const Member<Into>& one : members) all.push_back(one.name);
        problem = fmt::format("unknown member {}{}", printable(name), did_you_mean(name, all));
      } else if (problem = member->read(*this, *value, into); !problem.empty()) {
        problem = fmt::format("{}: {}", name, problem);
      }
      if (!problem.empty()) error(file_.name_position(*value), std::move(problem));
    }
  }

  static std::string read_values(BehaviourReader& reader, const Json& value, BehaviourReader&) {
    if (!value.is_object()) return R"(expected an object: {"OBJ": VALUE})";
    for (const auto& [name, text] : reader.file_.members(value)) {
      const FoundEntry found = reader.names_.find_one(name);
      std::string problem = found.problem;
      if (found.ok()) {
        ParsedValue parsed = parse_value_text(*found.entry, value_word(*text));
        problem = parsed.problem;
        reader.script_.values.push_back({found.entry, std::move(parsed.bytes)});
      }
      if (!problem.empty()) reader.error(reader.file_.name_position(*text), std::move(problem));
    }
    return {};
  }

  static std::string read_generators(BehaviourReader& reader, const Json& value, BehaviourReader&) {
    if (!value.is_object()) return R"(expected an object: {"OBJ": "ramp 0 100 5s"})";
    for (const auto& [name, text] : reader.file_.members(value)) {
      std::vector<std::string> words = command_words(value_word(*text));
      if (!words.empty()) words.insert(std::next(words.begin()), name);
      Generator generator;
      std::string problem = read_generator(words, reader.names_, generator);
      if (!problem.empty()) {
        reader.error(reader.file_.name_position(*text), std::move(problem));
      } else {
        reader.script_.generators.push_back(generator);
      }
    }
    return {};
  }

  static std::string read_copies(BehaviourReader& reader, const Json& value, BehaviourReader&) {
    if (!value.is_array()) return R"(expected an array: [{"from": "OBJ", "to": "OBJ"}])";
    for (const Json& item : value) {
      ValueCopy copy;
      reader.read_members(item, copy_members, copy);
      if (copy.from != nullptr && copy.to != nullptr) {
        reader.script_.copies.push_back(copy);
      } else if (item.is_object()) {
        reader.error(reader.file_.value_position(item), "a copy requires from and to");
      }
    }
    return {};
  }

  static std::string read_rules(BehaviourReader& reader, const Json& value, BehaviourReader&) {
    if (!value.is_array()) return R"(expected an array: [{"on": {...}, "do": ["..."]}])";
    for (const Json& item : value) {
      RuleParts parts;
      const auto errors = reader.diagnostics_.errors();
      reader.read_members(item, rule_members, parts);
      if (reader.diagnostics_.errors() > errors) continue;  // what a rule lacks may be what is wrong in it
      const std::string problem = reader.problem_of(item, parts);
      if (!problem.empty()) reader.error(reader.file_.value_position(item), problem);
      reader.script_.rules.push_back(std::move(parts.rule));
    }
    return {};
  }

  /// What a rule lacks, or what contradicts itself or another rule.
  [[nodiscard]] std::string problem_of(const Json& item, const RuleParts& parts) const {
    const BehaviourRule& rule = parts.rule;
    if (!parts.has_event) return "a rule requires on, with an event";
    const bool is_access = rule.event == BehaviourEvent::written || rule.event == BehaviourEvent::read;
    if (rule.refuse != canopen::ok && !is_access) return "refuse requires on written or read";
    if (rule.actions.empty() && rule.refuse == canopen::ok) return "a rule requires do or refuse";
    if (item.contains("once") && item.contains("times")) return "once and times contradict each other";
    const bool is_double = !rule.name.empty() && std::ranges::count(script_.rules, rule.name, &BehaviourRule::name) > 0;
    return is_double ? fmt::format("two rules have the name \"{}\"", printable(rule.name)) : std::string{};
  }

  // Members with simple values.

  [[nodiscard]] std::string read_number_object(const Json& value, const Entry*& entry) {
    const FoundEntry found = names_.find_one(value_word(value));
    if (!found.ok()) return found.problem;
    if (!has_number(*found.entry)) return fmt::format("\"{}\" is not a number", printable(found.entry->name));
    entry = found.entry;
    return {};
  }
  template <const Entry* ValueCopy::*member>
  static std::string read_copied(BehaviourReader& reader, const Json& value, ValueCopy& copy) {
    return reader.read_number_object(value, copy.*member);
  }
  [[nodiscard]] static std::string read_time(const Json& value, std::uint64_t& time_us) {
    const auto time = command_time(value_word(value));
    if (!time) return fmt::format("expected {}", duration_form);
    time_us = *time;
    return {};
  }
  /// A period of at least one millisecond: shorter ones could occupy the computer.
  [[nodiscard]] static std::string read_period(const Json& value, std::uint64_t& time_us) {
    constexpr std::uint64_t shortest_us = 1'000;
    std::string problem = read_time(value, time_us);
    return problem.empty() && time_us < shortest_us ? "expected at least 1ms" : problem;
  }
  [[nodiscard]] static std::string read_count(const Json& value, unsigned& count) {
    if (!value.is_number_unsigned() || value.get<std::uint64_t>() == 0 || value.get<std::uint64_t>() > max_count)
      return fmt::format("expected a number from 1 to {}", max_count);
    count = value.get<unsigned>();
    return {};
  }

  template <BehaviourEvent event>
  static std::string read_event_object(BehaviourReader& reader, const Json& value, RuleParts& parts) {
    const FoundEntry found = reader.names_.find_one(value_word(value));
    if (!found.ok()) return found.problem;
    parts.rule.entry = found.entry;
    if (event == BehaviourEvent::changes && !has_number(*found.entry))
      return fmt::format("\"{}\" is not a number", printable(found.entry->name));
    return set_event(parts, event);
  }
  template <BehaviourEvent event>
  static std::string read_event_time(BehaviourReader&, const Json& value, RuleParts& parts) {
    std::string problem =
        event == BehaviourEvent::every ? read_period(value, parts.rule.time_us) : read_time(value, parts.rule.time_us);
    return problem.empty() ? set_event(parts, event) : problem;
  }
  static std::string set_event(RuleParts& parts, BehaviourEvent event) {
    if (parts.has_event) return "a rule has one event";
    parts.has_event = true;
    parts.rule.event = event;
    return {};
  }

  static std::string read_on(BehaviourReader& reader, const Json& value, RuleParts& parts) {
    reader.read_members(value, event_members, parts);
    if (!parts.numbers.empty()) reader.read_condition(value, parts);
    return {};
  }
  static std::string note_number(BehaviourReader&, const Json& value, RuleParts& parts) {
    parts.numbers.push_back(&value);
    return {};
  }

  /// The numbers of a condition are values of the entry of the event.
  void read_condition(const Json& on, RuleParts& parts) {
    BehaviourRule& rule = parts.rule;
    if (rule.entry == nullptr || !has_number(*rule.entry))
      return error(file_.value_position(on),
                   "a condition requires written, read or changes of an object with a number");
    for (const auto& [name, value] : file_.members(on)) {
      if (std::ranges::find(parts.numbers, value) == parts.numbers.end()) continue;
      const std::string text = value_word(*value);
      const ParsedValue parsed = parse_unchecked(*rule.entry, text);
      if (!parsed.ok()) {
        error(file_.name_position(*value), fmt::format("{}: {}", name, parsed.problem));
        continue;
      }
      const double number = *entry_number(*rule.entry, parsed.bytes);
      if (name == "equals") rule.condition.equals = number;
      if (name == "above") rule.condition.above = number;
      if (name == "below") rule.condition.below = number;
      if (name == "mask") rule.condition.mask = bits_of_integer(number);
    }
  }

  static std::string read_actions(BehaviourReader& reader, const Json& value, RuleParts& parts) {
    if (!value.is_array()) return R"(expected an array of commands: ["set OBJ VALUE"])";
    for (const Json& item : value) {
      ParsedCommand command = parse_command(value_word(item), reader.names_);
      if (command.problem.empty()) {
        const std::vector<std::string> words = command_words(value_word(item));
        const auto row = std::ranges::find(command_rows(), std::string_view{words[0]}, &NodeCommandRow::name);
        if (!row->in_rules) command.problem = fmt::format("{} is not a command of rules", words[0]);
      }
      if (!command.problem.empty()) {
        reader.error(reader.file_.value_position(item), std::move(command.problem));
      } else {
        parts.rule.actions.push_back(std::move(command.action));
      }
    }
    return {};
  }

  void error(const Position& position, std::string message) {
    Diagnostic diagnostic;
    diagnostic.position = position;
    diagnostic.message = std::move(message);
    diagnostics_.report(std::move(diagnostic));
  }

  static constexpr Member<BehaviourReader> script_members[] = {
      {"set", read_values}, {"generate", read_generators}, {"copy", read_copies}, {"rules", read_rules}};

  static constexpr Member<ValueCopy> copy_members[] = {
      {"from", read_copied<&ValueCopy::from>},
      {"to", read_copied<&ValueCopy::to>},
      {"after", [](BehaviourReader&, const Json& value, ValueCopy& copy) { return read_time(value, copy.after_us); }}};

  static constexpr Member<RuleParts> rule_members[] = {
      {"name",
       [](BehaviourReader&, const Json& value, RuleParts& parts) {
         parts.rule.name = value_word(value);
         return std::string{value.is_string() ? "" : "expected a string"};
       }},
      {"on", read_on},
      {"after",
       [](BehaviourReader&, const Json& value, RuleParts& parts) { return read_time(value, parts.rule.after_us); }},
      {"do", read_actions},
      {"refuse",
       [](BehaviourReader&, const Json& value, RuleParts& parts) {
         const auto code = command_code(value_word(value), 0xFFFF'FFFF);
         if (!value.is_string() || !code || *code == 0)
           return std::string{R"(expected an abort code such as "0609 0030h")"};
         parts.rule.refuse = canopen::abort_code_from(*code);
         return std::string{};
       }},
      {"once",
       [](BehaviourReader&, const Json& value, RuleParts& parts) {
         if (!value.is_boolean()) return std::string{"expected true or false"};
         if (value.get<bool>()) parts.rule.times = 1;
         return std::string{};
       }},
      {"times", [](BehaviourReader&, const Json& value, RuleParts& parts) {
         return read_count(value, parts.rule.times.emplace());
       }}};

  static constexpr Member<RuleParts> event_members[] = {
      {"written", read_event_object<BehaviourEvent::written>},
      {"read", read_event_object<BehaviourEvent::read>},
      {"changes", read_event_object<BehaviourEvent::changes>},
      {"time", read_event_time<BehaviourEvent::time>},
      {"every", read_event_time<BehaviourEvent::every>},
      {"state",
       [](BehaviourReader&, const Json& value, RuleParts& parts) {
         bool is_known = true;
         parts.rule.state = state_named(value_word(value), is_known);
         return is_known ? set_event(parts, BehaviourEvent::state)
                         : std::string{"expected initialisation, pre-operational, operational or stopped"};
       }},
      {"sync",
       [](BehaviourReader&, const Json& value, RuleParts& parts) {
         std::string problem = read_count(value, parts.rule.number);
         return problem.empty() ? set_event(parts, BehaviourEvent::sync) : problem;
       }},
      {"power-on",
       [](BehaviourReader&, const Json& value, RuleParts& parts) {
         return value == true ? set_event(parts, BehaviourEvent::power_on) : std::string{"expected true"};
       }},
      {"equals", note_number},
      {"mask", note_number},
      {"above", note_number},
      {"below", note_number},
      {"changed", [](BehaviourReader&, const Json& value, RuleParts& parts) {
         if (!value.is_boolean()) return std::string{"expected true or false"};
         parts.rule.changed = value.get<bool>();
         return std::string{};
       }}};

  JsonFile file_;
  EntryFinder& names_;
  Diagnostics& diagnostics_;
  BehaviourScript script_;
};

}  // namespace

BehaviourScript read_behaviour_script(const SourceFile& source, EntryFinder& names, Diagnostics& diagnostics) {
  return BehaviourReader{source, names, diagnostics}.read();
}

}  // namespace edsc
