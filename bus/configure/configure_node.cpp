#include "configure/configure_node.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <span>

#include "text/number_text.hpp"
#include "values/little_endian.hpp"
#include "values/parse_value.hpp"

namespace edsc {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t word_size = 4;

std::optional<std::uint32_t> word_of(const Bytes& bytes) {
  return bytes.size() == word_size ? std::optional{static_cast<std::uint32_t>(number_of(bytes))} : std::nullopt;
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
    for (std::size_t i = 0; i < refused_.size() && !is_lost(); ++i) write(*refused_[i], refused_[i]->bytes, true);
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
    if (result_.lost && last_ != nullptr) result_.lost_at = *last_;
    return result_.lost;
  }

  static bool counts(const ConfigurationStep& step) {
    return step.value != nullptr && (step.kind == StepKind::write || step.kind == StepKind::switch_on);
  }

  void carry_out(const ConfigurationStep& step) {
    last_ = &step.entry;
    switch (step.kind) {
      case StepKind::write: return write(step, step.bytes);
      case StepKind::switch_off: return switch_off(step);
      case StepKind::switch_on: return switch_on(step);
      case StepKind::clear: return clear(step);
      case StepKind::restore: return restore(step);
    }
  }

  /// A refused value is written again after all others.
  void write(const ConfigurationStep& step, const Bytes& bytes, bool is_again = false) {
    const SdoOutcome outcome = node_.download(step.entry.index, step.entry.sub_index, bytes);
    if (outcome.done()) {
      if (!counts(step)) return;
      ++result_.written;
      written_.push_back(&step);
    } else if (outcome.end == SdoEnd::refused && step.group == 0 && step.kind == StepKind::write && !is_again) {
      refused_.push_back(&step);
    } else {
      fail(step, outcome);
    }
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
    write(step, bytes_of(off, word_size));
    if (!given_up_.contains(step.group)) disabled_[step.group] = &step.entry;
  }

  void switch_on(const ConfigurationStep& step) {
    if (!step.bytes.empty()) return write(step, step.bytes);
    const auto before = before_.find(key(step.entry));
    if (before != before_.end()) write(step, bytes_of(before->second, word_size));
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
    last_ = &step.entry;
    const SdoOutcome outcome = upload(node_, step.entry);
    const bool is_write_only = outcome.end == SdoEnd::refused && outcome.code == canopen::AbortCode::write_only;
    if (is_write_only) return;
    if (!outcome.done()) {
      fail(step, outcome);
    } else if (holds(step.entry, outcome, step.bytes)) {
      ++result_.verified;
    } else {
      add_failure(step, "reads back as " + value_of(step.entry, outcome.bytes));
    }
  }

  void fail(const ConfigurationStep& step, const SdoOutcome& outcome) {
    std::string what = failure_text(outcome);
    if (step.group != 0 && given_up_.insert(step.group).second && outcome.end == SdoEnd::refused) {
      what += "; the related entries are not changed";
      if (const auto disabled = disabled_.find(step.group); disabled != disabled_.end()) {
        what += ", but " + entry_label(disabled->second->index, disabled->second->sub_index) + " remains disabled";
      }
    }
    add_failure(step, std::move(what));
    result_.lost = outcome.end == SdoEnd::no_answer;
  }

  void add_failure(const ConfigurationStep& step, std::string what) {
    result_.failures.push_back({step.entry, step.value, std::move(what), position_of(step)});
  }

  /// A step without a value is carried out for a later value of its entry, or for another value of its group.
  [[nodiscard]] Position position_of(const ConfigurationStep& step) const {
    const ConfigurationValue* value = step.value;
    for (const ConfigurationStep& other : steps_) {
      if (other.value == nullptr || other.group != step.group) continue;
      if (value == nullptr || (step.value == nullptr && key(other.entry) == key(step.entry))) value = other.value;
    }
    return value != nullptr ? value->position : Position{};
  }

  static std::uint32_t key(const LiveEntry& entry) { return std::uint32_t{entry.index} << 8 | entry.sub_index; }

  SdoAccess& node_;
  const std::vector<ConfigurationStep>& steps_;
  const ConfigurationHooks& hooks_;
  ConfigurationResult result_;
  const LiveEntry* last_ = nullptr;  ///< of the last transfer
  std::vector<const ConfigurationStep*> refused_, written_;
  std::map<std::uint32_t, std::uint32_t> before_;
  std::map<std::uint32_t, Bytes> cleared_;
  std::map<unsigned, const LiveEntry*> disabled_;  ///< the COB-ID of a group
  std::set<unsigned> given_up_;
};

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
  const auto day = parse_form<3>(date, "00-00-0000");  // month, day, year
  const auto clock = parse_form<2>(time.substr(0, 5), "00:00");
  if (!day || !clock) return std::nullopt;
  const auto days = days_of_date((*day)[2], (*day)[0], (*day)[1]);
  const auto [hour, minute] = *clock;
  const std::string_view half = time.substr(5);
  const bool afternoon = half == "PM" || half == "pm";
  if (!days || (!afternoon && half != "AM" && half != "am") || hour == 0 || hour > 12 || minute > 59)
    return std::nullopt;
  return ConfigurationTime{*days, ((hour % 12 + (afternoon ? 12 : 0)) * 60 + minute) * 60'000};
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
    const SdoOutcome outcome = node.download(0x1020, sub_index, bytes_of(word, word_size));
    if (!outcome.done()) return failure_text(outcome);
  }
  return {};
}

}  // namespace edsc
