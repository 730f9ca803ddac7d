#include "conform/cases/shared/entry_results.hpp"

#include <fmt/format.h>

#include <utility>

namespace edsc::conform {

void EntryResults::List::add(const LiveEntry& entry, std::string_view what) {
  std::string line = fmt::format("{}: {}", title(entry), what);
  if (line == last) return;
  if (size++ < max_named) text += (text.empty() ? "" : "; ") + line;
  last = std::move(line);
}

std::string EntryResults::List::whole() const {
  return size <= max_named ? text : fmt::format("{}; and {} more", text, size - max_named);
}

void EntryResults::note(const SdoOutcome& outcome) { silent_ = outcome.end == SdoEnd::no_answer ? silent_ + 1 : 0; }

void EntryResults::expect_done(const LiveEntry& entry, const SdoOutcome& outcome) {
  note(outcome);
  if (!outcome.done()) add_failure(entry, failure_text(outcome));
}

bool EntryResults::expect_abort(const LiveEntry& entry, const SdoOutcome& outcome, const AbortRule& rule,
                                std::string_view done) {
  note(outcome);
  const bool is_refused = outcome.end == SdoEnd::refused && rule.is_accepted(outcome.code);
  if (!is_refused) {
    add_failure(entry, outcome.done() ? std::string{done} : failure_text(outcome));
  } else if (!rule.is_standard(outcome.code)) {
    add_warning(entry, failure_text(outcome));
  }
  return is_refused;
}

void EntryResults::add_failure(const LiveEntry& entry, std::string_view got) {
  failures_.add(entry, got);
  failed_.push_back({entry.index, entry.sub_index});
  dut_.name_transfer(entry.index, entry.sub_index);
}
void EntryResults::add_warning(const LiveEntry& entry, std::string_view text) { warnings_.add(entry, text); }

void EntryResults::finish(const std::string& expected, const std::string& why_none) {
  if (warnings_.size != 0) dut_.warn(fmt::format("expected: {}; got: {}", expected, warnings_.whole()));
  if (failures_.size != 0) {
    dut_.fail(expected, failures_.whole() + (lost() ? "; the device does not answer, other entries not tested" : ""),
              std::move(failed_));
  }
  if (tried_ == 0) dut_.not_applicable(why_none);
}

}  // namespace edsc::conform
