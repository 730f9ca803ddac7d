#include "device/behaviour.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <canopen/od/dictionary.hpp>
#include <cmath>
#include <utility>

#include "text/printable.hpp"
#include "text/suggestion.hpp"

namespace edsc {
namespace {

constexpr std::uint64_t least_fire_us = 1'000;

std::uint32_t key_of_entry(const Entry& entry) { return canopen::object_key(entry.index, entry.sub_index); }

bool is_entry(const BehaviourRule& rule, BehaviourEvent event, std::uint16_t index, std::uint8_t sub_index) {
  return rule.event == event && rule.entry->index == index && rule.entry->sub_index == sub_index;
}

std::string abort_text(canopen::AbortCode code) {
  return fmt::format("{:08X}h {}", static_cast<std::uint32_t>(code), canopen::to_text(code));
}

}  // namespace

bool NumberCondition::holds(double number) const {
  if (above && !(number > *above)) return false;
  if (below && !(number < *below)) return false;
  if (!mask) return !equals || number == *equals;
  const std::uint64_t bits = bits_of_integer(number) & *mask;
  return equals ? bits == (bits_of_integer(*equals) & *mask) : bits != 0;
}

Behaviour::Behaviour(BehaviourTarget& target, std::uint64_t seed) : target_{target}, seed_{seed} {}

void Behaviour::add(const BehaviourScript& script) {
  scripts_.push_back(script);
  for (const ValueCopy& copy : script.copies) copies_.push_back({copy, std::nullopt});
  for (const BehaviourRule& rule : script.rules) {
    rules_.push_back({rule, 0, std::nullopt, 0, std::nullopt});
    if (is_on_) begin(rules_.back());
  }
  if (!is_on_) return;
  set_values(script);
  begin_generators(script);
  has_event_ = true;
}

void Behaviour::begin(RunningRule& rule) {
  rule.syncs = 0;
  rule.last.reset();
  rule.next_us.reset();
  if (rule.rule.event == BehaviourEvent::time || rule.rule.event == BehaviourEvent::every)
    rule.next_us = now_us_ + rule.rule.time_us;
}

void Behaviour::begin_generators(const BehaviourScript& script) {
  for (const Generator& generator : script.generators) start(generator);
}

void Behaviour::set_values(const BehaviourScript& script) {
  for (const BehaviourScript::Value& value : script.values) {
    const CommandAnswer answer = set(*value.entry, value.bytes);
    if (!answer.ok && report) report(answer.text);
  }
}

CommandAnswer Behaviour::set(const Entry& entry, std::span<const std::uint8_t> bytes) {
  const canopen::AbortCode code = target_.set(entry.index, entry.sub_index, bytes);
  has_event_ = true;
  if (code == canopen::ok) return {};
  return {false, fmt::format("{:04X}h:{:02X}: {}", entry.index, entry.sub_index, abort_text(code))};
}

void Behaviour::start(Generator generator) {
  generator.settings.seed = seed_ + key_of_entry(*generator.entry);
  generators_.insert_or_assign(key_of_entry(*generator.entry), RunningGenerator{generator, now_us_});
}

void Behaviour::follow(const ValueCopy& copy) {
  copies_.push_back({copy, std::nullopt});
  has_event_ = true;
}

CommandAnswer Behaviour::stop(const Entry& entry) {
  const std::size_t copies = std::erase_if(copies_, [&](const RunningCopy& copy) { return copy.copy.to == &entry; });
  if (generators_.erase(key_of_entry(entry)) + copies > 0) return {};
  return {false, fmt::format("{:04X}h:{:02X} does not have a generator", entry.index, entry.sub_index)};
}

CommandAnswer Behaviour::fire(std::string_view rule) {
  const auto at = std::ranges::find_if(rules_, [rule](const RunningRule& one) { return one.rule.name == rule; });
  if (at != rules_.end()) {
    // Later: a rule that fires itself, also by others, leaves time for the node.
    execute_later(std::max(at->rule.after_us, least_fire_us), [this, &rule = *at] { execute(rule.rule); });
    return {};
  }
  std::vector<std::string> names;
  for (const RunningRule& one : rules_) names.push_back(one.rule.name);
  return {false, fmt::format("\"{}\" is not a rule{}", printable(rule), did_you_mean(rule, names))};
}

void Behaviour::on_power_on(std::uint64_t now_us) {
  now_us_ = now_us;
  is_on_ = true;
  pending_.clear();
  for (RunningCopy& copy : copies_) copy.last.reset();
  for (const BehaviourScript& script : scripts_) begin_generators(script);
  for (RunningRule& rule : rules_) {
    begin(rule);
    if (rule.rule.event == BehaviourEvent::power_on) happen(rule);
  }
  has_event_ = true;
}

canopen::AbortCode Behaviour::before_write(std::uint16_t index, std::uint8_t sub_index,
                                           std::span<const std::uint8_t> bytes) {
  before_.reset();
  canopen::AbortCode code = canopen::ok;
  for (RunningRule& one : rules_) {
    const BehaviourRule& rule = one.rule;
    if (!is_entry(rule, BehaviourEvent::written, index, sub_index)) continue;
    if (!before_) before_ = number_of(*rule.entry);
    if (rule.refuse == canopen::ok || code != canopen::ok) continue;
    const std::optional<double> number = entry_number(*rule.entry, bytes);
    if (number && !rule.condition.holds(*number)) continue;
    if (rule.times && one.count >= *rule.times) continue;
    code = rule.refuse;
    happen(one);
  }
  return code;
}

void Behaviour::after_write(std::uint16_t index, std::uint8_t sub_index) {
  has_event_ = true;
  for (RunningRule& one : rules_) {
    const BehaviourRule& rule = one.rule;
    if (!is_entry(rule, BehaviourEvent::written, index, sub_index) || rule.refuse != canopen::ok) continue;
    const std::optional<double> number = number_of(*rule.entry);
    if (number && !rule.condition.holds(*number)) continue;
    if (!rule.changed || number != before_) happen(one);
  }
}

canopen::AbortCode Behaviour::before_read(std::uint16_t index, std::uint8_t sub_index) {
  canopen::AbortCode code = canopen::ok;
  for (RunningRule& one : rules_) {
    if (!is_entry(one.rule, BehaviourEvent::read, index, sub_index)) continue;
    const std::optional<double> number = number_of(*one.rule.entry);
    if (number && !one.rule.condition.holds(*number)) continue;
    if (one.rule.times && one.count >= *one.rule.times) continue;
    happen(one);
    if (code == canopen::ok) code = one.rule.refuse;
  }
  return code;
}

void Behaviour::on_state(canopen::NmtState state) {
  has_event_ = true;
  if (state == canopen::NmtState::initialisation) {
    for (const BehaviourScript& script : scripts_) set_values(script);
  }
  for (RunningRule& rule : rules_) {
    if (rule.rule.event == BehaviourEvent::state && rule.rule.state == state) happen(rule);
  }
}

void Behaviour::on_sync() {
  has_event_ = true;
  for (RunningRule& rule : rules_) {
    if (rule.rule.event == BehaviourEvent::sync && ++rule.syncs % rule.rule.number == 0) happen(rule);
  }
}

void Behaviour::on_time(std::uint64_t now_us) {
  now_us_ = now_us;
  if (!is_on_) return;
  run_timed_rules();
  run_generators();
  // What follows from these is executed by the next call: rules that cause each other do not stop the other nodes.
  std::vector<Work> due;
  for (auto first = pending_.begin(); first != pending_.end() && first->first <= now_us;) {
    due.push_back(std::move(first->second));
    first = pending_.erase(first);
  }
  for (const Work& work : due) work();
  if (has_event_) look_for_changes();
}

std::optional<std::uint64_t> Behaviour::next_us() const {
  if (!is_on_) return std::nullopt;
  if (has_event_) return now_us_;
  std::optional<std::uint64_t> next;
  const auto consider = [&next](std::uint64_t time) { next = next ? std::min(*next, time) : time; };
  for (const auto& [key, running] : generators_) consider(running.next_us());
  for (const RunningRule& rule : rules_) {
    if (rule.next_us) consider(*rule.next_us);
  }
  if (!pending_.empty()) consider(pending_.begin()->first);
  return next;
}

std::optional<double> Behaviour::number_of(const Entry& entry) {
  const auto bytes = target_.get(entry.index, entry.sub_index);
  return bytes ? entry_number(entry, *bytes) : std::nullopt;
}

void Behaviour::set_number(const Entry& entry, double number, OutOfRange out_of_range) {
  // A value outside the limits of the EDS is not set: the last one remains.
  static_cast<void>(set(entry, entry_bytes(entry, number, out_of_range)));
}

void Behaviour::run_generators() {
  for (auto at = generators_.begin(); at != generators_.end();) {
    RunningGenerator& running = at->second;
    const Generator& generator = running.generator;
    if (running.next_us() > now_us_) {
      ++at;
      continue;
    }
    // After a delay, only the last of the values that are due is set.
    const std::uint64_t step = (now_us_ - running.start_us) / generator.interval_us;
    const std::uint64_t elapsed = step * generator.interval_us;
    const double number = generator.kind->value(generator.settings, elapsed, step);
    running.next_step = step + 1;
    set_number(*generator.entry, number, generator.kind->out_of_range);
    at = generator.kind->ends && elapsed >= generator.settings.time_us ? generators_.erase(at) : std::next(at);
  }
}

void Behaviour::run_timed_rules() {
  for (RunningRule& one : rules_) {
    if (!one.next_us || *one.next_us > now_us_) continue;
    if (one.rule.event == BehaviourEvent::every) {
      const std::uint64_t late = (now_us_ - *one.next_us) / one.rule.time_us;
      *one.next_us += (late + 1) * one.rule.time_us;
    } else {
      one.next_us.reset();
    }
    happen(one);
  }
}

void Behaviour::look_for_changes() {
  has_event_ = false;
  for (RunningRule& one : rules_) {
    if (one.rule.event != BehaviourEvent::changes) continue;
    const std::optional<double> number = number_of(*one.rule.entry);
    const std::optional<double> last = std::exchange(one.last, number);
    if (!last || !number || *number == *last || !one.rule.condition.holds(*number)) continue;
    // A limit is passed once.
    const bool is_limit = one.rule.condition.above || one.rule.condition.below;
    if (!is_limit || !one.rule.condition.holds(*last)) happen(one);
  }
  for (RunningCopy& one : copies_) {
    const std::optional<double> number = number_of(*one.copy.from);
    if (!number || number == one.last) continue;
    one.last = number;
    execute_later(one.copy.after_us,
                  [this, to = one.copy.to, value = *number] { set_number(*to, value, OutOfRange::nearest); });
  }
}

void Behaviour::happen(RunningRule& rule) {
  if (rule.rule.times && rule.count >= *rule.rule.times) return;
  ++rule.count;
  execute_later(rule.rule.after_us, [this, &rule] { execute(rule.rule); });
}

void Behaviour::execute(const BehaviourRule& rule) {
  for (const BehaviourAction& action : rule.actions) {
    const CommandAnswer answer = action(*this);
    if (!answer.ok && report) report(fmt::format("rule \"{}\": {}", printable(rule.name), answer.text));
  }
}

void Behaviour::execute_later(std::uint64_t after_us, Work work) {
  pending_.emplace(now_us_ + after_us, std::move(work));
}

}  // namespace edsc
