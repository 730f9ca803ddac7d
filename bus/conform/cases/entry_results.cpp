#include "conform/cases/entry_results.hpp"

#include <fmt/format.h>

namespace edsc::conform {

void EntryResults::List::add(const LiveEntry& entry, std::string_view what) {
  if (size++ >= max_named) return;
  text += fmt::format("{}{}: {}", text.empty() ? "" : "; ", title(entry), what);
}

std::string EntryResults::List::whole() const {
  return size <= max_named ? text : fmt::format("{}; and {} more", text, size - max_named);
}

void EntryResults::note(const SdoOutcome& outcome) { silent_ = outcome.end == SdoEnd::no_answer ? silent_ + 1 : 0; }

void EntryResults::expect_done(const LiveEntry& entry, const SdoOutcome& outcome) {
  note(outcome);
  if (!outcome.done()) add_failure(entry, failure_text(outcome));
}

void EntryResults::expect_abort(const LiveEntry& entry, const SdoOutcome& outcome, const AbortRule& rule,
                                std::string_view done) {
  note(outcome);
  if (outcome.done()) return add_failure(entry, done);
  if (outcome.end != SdoEnd::refused || !rule.is_accepted(outcome.code))
    return add_failure(entry, failure_text(outcome));
  if (!rule.is_standard(outcome.code)) add_warning(entry, failure_text(outcome));
}

void EntryResults::add_failure(const LiveEntry& entry, std::string_view got) { failures_.add(entry, got); }
void EntryResults::add_warning(const LiveEntry& entry, std::string_view text) { warnings_.add(entry, text); }

void EntryResults::finish(const std::string& expected, const std::string& why_none) {
  if (warnings_.size != 0) dut_.warn(fmt::format("expected: {}; got: {}", expected, warnings_.whole()));
  if (failures_.size != 0) {
    dut_.fail(expected, failures_.whole() + (lost() ? "; the device does not answer, other entries not tested" : ""));
  }
  if (tried_ == 0) dut_.not_applicable(why_none);
}

}  // namespace edsc::conform
