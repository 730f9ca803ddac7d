#include "live/configure_node.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstring>
#include <map>
#include <set>

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

class Run {
 public:
  Run(SdoAccess& node, const std::vector<ConfigurationStep>& steps,
      const std::function<void(std::size_t, std::size_t)>& progress)
      : node_{node}, steps_{steps}, progress_{progress} {
    for (const ConfigurationStep& step : steps) result_.values += counts(step) ? 1 : 0;
  }

  ConfigurationResult run() {
    for (const ConfigurationStep& step : steps_) {
      if (result_.lost) break;
      progress_(result_.written, result_.values);
      if (step.group == 0 || !given_up_.contains(step.group)) carry_out(step);
    }
    for (std::size_t i = 0; i < refused_.size() && !result_.lost; ++i) try_again(*refused_[i]);
    for (std::size_t i = 0; i < written_.size() && !result_.lost; ++i) {
      progress_(i, written_.size());
      verify(*written_[i]);
    }
    return std::move(result_);
  }

 private:
  static bool counts(const ConfigurationStep& step) {
    return step.value != nullptr && (step.kind == StepKind::write || step.kind == StepKind::switch_on);
  }

  void carry_out(const ConfigurationStep& step) {
    switch (step.kind) {
      case StepKind::write: return write(step, step.bytes);
      case StepKind::switch_off: return switch_off(step);
      case StepKind::switch_on: return switch_on(step);
      case StepKind::clear: return clear(step);
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

  /// Keeps what was there for `switch_on`.
  void switch_off(const ConfigurationStep& step) {
    const SdoOutcome outcome = upload(node_, step.entry);
    if (!outcome.done()) return fail(step, outcome);
    const auto cob_id = word_of(outcome.bytes);
    if (!cob_id) return;  // no COB-ID as CiA 301 has it: the device judges what is written
    const std::uint32_t off = (*cob_id | step.off_set) & ~step.off_cleared;
    before_[key(step.entry)] = *cob_id;
    if (off != *cob_id) write(step, bytes_of(off));
  }

  void switch_on(const ConfigurationStep& step) {
    if (!step.bytes.empty()) return write(step, step.bytes);
    const auto before = before_.find(key(step.entry));
    if (before == before_.end()) return;
    const std::uint32_t off = (before->second | step.off_set) & ~step.off_cleared;
    if (off != before->second) write(step, bytes_of(before->second));
  }

  void clear(const ConfigurationStep& step) {
    const SdoOutcome outcome = upload(node_, step.entry);
    if (!outcome.done()) return fail(step, outcome);
    const bool clear = std::ranges::all_of(outcome.bytes, [](std::uint8_t byte) { return byte == 0; });
    if (!clear) write(step, Bytes(outcome.bytes.size(), 0));
  }

  void verify(const ConfigurationStep& step) {
    if (step.entry.entry != nullptr && !canopen::readable(step.entry.entry->access)) return;
    const SdoOutcome outcome = upload(node_, step.entry);
    if (!outcome.done()) {
      fail(step, outcome);
    } else if (reads_back(outcome, step.bytes)) {
      ++result_.verified;
    } else {
      result_.failures.push_back({step.entry, step.value, "reads back as " + value_of(step.entry, outcome.bytes)});
    }
  }

  void fail(const ConfigurationStep& step, const SdoOutcome& outcome) {
    std::string what = failure_text(outcome);
    if (step.group != 0 && given_up_.insert(step.group).second && outcome.end == SdoEnd::refused) {
      what += "; what belongs to it is left as it is now";
    }
    result_.failures.push_back({step.entry, step.value, std::move(what)});
    result_.lost = outcome.end == SdoEnd::no_answer;
  }

  static std::uint32_t key(const LiveEntry& entry) { return std::uint32_t{entry.index} << 8 | entry.sub_index; }

  SdoAccess& node_;
  const std::vector<ConfigurationStep>& steps_;
  const std::function<void(std::size_t, std::size_t)>& progress_;
  ConfigurationResult result_;
  std::vector<const ConfigurationStep*> refused_, written_;
  std::map<std::uint32_t, std::uint32_t> before_;
  std::set<unsigned> given_up_;
};

/// A number of two or four digits, and what stands behind it; false when it is none, or above `most`.
bool take(std::string_view& text, std::size_t digits, char behind, unsigned most, unsigned& number) {
  if (text.size() < digits) return false;
  const auto [end, error] = std::from_chars(text.data(), text.data() + digits, number);
  if (error != std::errc{} || end != text.data() + digits || number > most) return false;
  text.remove_prefix(digits);
  if (behind == 0) return true;
  if (!text.starts_with(behind)) return false;
  text.remove_prefix(1);
  return true;
}

}  // namespace

ConfigurationResult configure_node(SdoAccess& node, const std::vector<ConfigurationStep>& steps,
                                   const std::function<void(std::size_t, std::size_t)>& progress) {
  return Run{node, steps, progress}.run();
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
