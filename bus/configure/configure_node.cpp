#include "configure/configure_node.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstring>
#include <map>
#include <set>
#include <span>

namespace edsc {
namespace {

using Bytes = std::vector<std::uint8_t>;

std::optional<std::uint32_t> word_of(const Bytes& bytes) {
  if (bytes.size() != sizeof(std::uint32_t)) return std::nullopt;
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data(), sizeof word);
  return word;
}

Bytes bytes_of(std::uint32_t word) {
  Bytes bytes(sizeof word);
  std::memcpy(bytes.data(), &word, sizeof word);
  return bytes;
}

bool can_be_read(const LiveEntry& entry) { return entry.entry == nullptr || canopen::readable(entry.entry->access); }

/// Whether the node has the value, ignoring a trailing 00h of a VISIBLE_STRING.
bool holds(const LiveEntry& entry, const SdoOutcome& outcome, std::span<const std::uint8_t> bytes) {
  if (reads_back(outcome, bytes)) return true;
  if (entry.type == nullptr || entry.type->type != canopen::DataType::visible_string) return false;
  const auto text = [](std::span<const std::uint8_t> with_padding) {
    while (!with_padding.empty() && with_padding.back() == 0)
      with_padding = with_padding.first(with_padding.size() - 1);
    return with_padding;
  };
  return std::ranges::equal(text(outcome.bytes), text(bytes));
}

class Run {
 public:
  Run(SdoAccess& node, const std::vector<ConfigurationStep>& steps, const ConfigurationHooks& hooks)
      : node_{node}, steps_{steps}, hooks_{hooks} {
    for (const ConfigurationStep& step : steps) result_.values += counts(step) ? 1 : 0;
  }

  ConfigurationResult run() {
    for (const ConfigurationStep& step : steps_) {
      if (is_lost()) break;
      hooks_.progress(result_.written, result_.values);
      if (step.group == 0 || !given_up_.contains(step.group)) carry_out(step);
    }
    for (std::size_t i = 0; i < refused_.size() && !is_lost(); ++i) try_again(*refused_[i]);
    for (std::size_t i = 0; i < written_.size() && !is_lost(); ++i) {
      hooks_.progress(i, written_.size());
      verify(*written_[i]);
    }
    (void)is_lost();
    return std::move(result_);
  }

 private:
  [[nodiscard]] bool is_lost() {
    if (hooks_.restarted()) result_.lost = result_.restarted = true;
    return result_.lost;
  }

  static bool counts(const ConfigurationStep& step) {
    return step.value != nullptr && (step.kind == StepKind::write || step.kind == StepKind::switch_on);
  }

  void carry_out(const ConfigurationStep& step) {
    switch (step.kind) {
      case StepKind::write: return write(step, step.bytes);
      case StepKind::switch_off: return switch_off(step);
      case StepKind::switch_on: return switch_on(step);
      case StepKind::clear: return clear(step);
      case StepKind::restore: return restore(step);
    }
  }

  void write(const ConfigurationStep& step, const Bytes& bytes) {
    const SdoOutcome outcome = node_.download(step.entry.index, step.entry.sub_index, bytes);
    if (outcome.done()) {
      if (counts(step)) note_written(step);
      return;
    }
    if (outcome.end == SdoEnd::refused && step.group == 0 && step.kind == StepKind::write) {
      refused_.push_back(&step);
      return;
    }
    fail(step, outcome);
  }

  void try_again(const ConfigurationStep& step) {
    const SdoOutcome outcome = node_.download(step.entry.index, step.entry.sub_index, step.bytes);
    if (outcome.done()) return note_written(step);
    fail(step, outcome);
  }

  void note_written(const ConfigurationStep& step) {
    ++result_.written;
    written_.push_back(&step);
  }

  /// Stores the previous value for `switch_on`, unless it was disabled.
  void switch_off(const ConfigurationStep& step) {
    const SdoOutcome outcome = upload(node_, step.entry);
    if (!outcome.done()) return fail(step, outcome);
    const auto cob_id = word_of(outcome.bytes);
    if (!cob_id) return;  // not a COB-ID of CiA 301: the device decides whether the value is valid
    const std::uint32_t off = (*cob_id | step.off_set) & ~step.off_cleared;
    if (off == *cob_id) return;
    before_[key(step.entry)] = *cob_id;
    write(step, bytes_of(off));
  }

  void switch_on(const ConfigurationStep& step) {
    if (!step.bytes.empty()) return write(step, step.bytes);
    const auto before = before_.find(key(step.entry));
    if (before != before_.end()) write(step, bytes_of(before->second));
  }

  void clear(const ConfigurationStep& step) {
    const SdoOutcome outcome = upload(node_, step.entry);
    if (!outcome.done()) return fail(step, outcome);
    cleared_[key(step.entry)] = outcome.bytes;
    const bool clear = std::ranges::all_of(outcome.bytes, [](std::uint8_t byte) { return byte == 0; });
    if (!clear) write(step, Bytes(outcome.bytes.size(), 0));
  }

  /// The numbers are low byte first and as long as each other, or one of them is empty.
  void restore(const ConfigurationStep& step) {
    const Bytes& before = cleared_[key(step.entry)];
    const bool more =
        std::ranges::lexicographical_compare(before.rbegin(), before.rend(), step.bytes.rbegin(), step.bytes.rend());
    const Bytes& wanted = before.empty() || more ? step.bytes : before;
    if (std::ranges::any_of(wanted, [](std::uint8_t byte) { return byte != 0; })) write(step, wanted);
  }

  void verify(const ConfigurationStep& step) {
    if (!can_be_read(step.entry)) return;
    const SdoOutcome outcome = upload(node_, step.entry);
    const bool is_write_only = outcome.end == SdoEnd::refused && outcome.code == canopen::AbortCode::write_only;
    if (is_write_only) return;
    if (!outcome.done()) {
      fail(step, outcome);
    } else if (holds(step.entry, outcome, step.bytes)) {
      ++result_.verified;
    } else {
      result_.failures.push_back({step.entry, step.value, "reads back as " + value_of(step.entry, outcome.bytes)});
    }
  }

  void fail(const ConfigurationStep& step, const SdoOutcome& outcome) {
    std::string what = failure_text(outcome);
    if (step.group != 0 && given_up_.insert(step.group).second && outcome.end == SdoEnd::refused) {
      what += "; the related entries are not changed";
    }
    result_.failures.push_back({step.entry, step.value, std::move(what)});
    result_.lost = outcome.end == SdoEnd::no_answer;
  }

  static std::uint32_t key(const LiveEntry& entry) { return std::uint32_t{entry.index} << 8 | entry.sub_index; }

  SdoAccess& node_;
  const std::vector<ConfigurationStep>& steps_;
  const ConfigurationHooks& hooks_;
  ConfigurationResult result_;
  std::vector<const ConfigurationStep*> refused_, written_;
  std::map<std::uint32_t, std::uint32_t> before_;
  std::map<std::uint32_t, Bytes> cleared_;
  std::set<unsigned> given_up_;
};

/// Reads a number of two or four digits and the character after it; false if it is invalid, or above `most`.
bool take(std::string_view& text, std::size_t digits, char separator, unsigned most, unsigned& number) {
  if (text.size() < digits) return false;
  const auto [end, error] = std::from_chars(text.data(), text.data() + digits, number);
  if (error != std::errc{} || end != text.data() + digits || number > most) return false;
  text.remove_prefix(digits);
  if (separator == 0) return true;
  if (!text.starts_with(separator)) return false;
  text.remove_prefix(1);
  return true;
}

}  // namespace

ConfigurationResult configure_node(SdoAccess& node, const std::vector<ConfigurationStep>& steps,
                                   const ConfigurationHooks& hooks) {
  return Run{node, steps, hooks}.run();
}

Comparison compare_configuration(SdoAccess& node, const std::vector<ConfigurationValue>& values,
                                 const ConfigurationHooks& hooks) {
  Comparison comparison;
  for (const ConfigurationValue& value : values) {
    hooks.progress(comparison.values.size(), values.size());
    ComparedValue compared;
    compared.found.end = SdoEnd::refused;
    if (!has_effect(value, values)) {
      comparison.values.push_back(std::move(compared));
      continue;
    }
    if (can_be_read(value.entry)) compared.found = upload(node, value.entry);
    if (compared.found.end == SdoEnd::no_answer) {
      comparison.lost = true;
      break;
    }
    compared.differs = !compared.known() || !holds(value.entry, compared.found, value.bytes);
    comparison.values.push_back(std::move(compared));
  }
  return comparison;
}

std::optional<ConfigurationTime> parse_configuration_time(std::string_view date, std::string_view time) {
  using namespace std::chrono;
  unsigned month_number = 0, day_number = 0, year_number = 0, hour = 0, minute = 0;
  if (!take(date, 2, '-', 12, month_number) || !take(date, 2, '-', 31, day_number)) return std::nullopt;
  if (!take(date, 4, 0, 9999, year_number) || !date.empty()) return std::nullopt;
  if (!take(time, 2, ':', 12, hour) || !take(time, 2, 0, 59, minute)) return std::nullopt;
  const bool afternoon = time == "PM" || time == "pm";
  if ((!afternoon && time != "AM" && time != "am") || hour == 0) return std::nullopt;
  const year_month_day day{year{static_cast<int>(year_number)}, month{month_number}, std::chrono::day{day_number}};
  if (!day.ok()) return std::nullopt;
  const auto days_since = (sys_days{day} - sys_days{year{1984} / January / 1}).count();
  if (days_since < 0) return std::nullopt;
  const unsigned hours = hour % 12 + (afternoon ? 12 : 0);
  return ConfigurationTime{static_cast<std::uint32_t>(days_since), (hours * 60 + minute) * 60'000};
}

std::optional<ConfigurationTime> read_configuration_time(SdoAccess& node) {
  const SdoOutcome date = node.upload(0x1020, 1);
  if (!date.done()) return std::nullopt;
  const SdoOutcome time = node.upload(0x1020, 2);
  if (!time.done()) return std::nullopt;
  const auto date_word = word_of(date.bytes), time_word = word_of(time.bytes);
  if (!date_word || !time_word) return std::nullopt;
  return ConfigurationTime{*date_word, *time_word};
}

std::string write_configuration_time(SdoAccess& node, ConfigurationTime time) {
  for (const auto& [sub_index, word] : {std::pair{std::uint8_t{1}, time.date}, std::pair{std::uint8_t{2}, time.time}}) {
    const SdoOutcome outcome = node.download(0x1020, sub_index, bytes_of(word));
    if (!outcome.done()) return failure_text(outcome);
  }
  return {};
}

}  // namespace edsc
