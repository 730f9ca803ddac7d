/// How a case ends: expectations, and the verdicts that follow from them.
#include <fmt/format.h>

#include "conform/dut/dut.hpp"

namespace edsc::conform {

namespace sdo = canopen::sdo;

std::string milliseconds_text(std::uint64_t time_us) {
  return fmt::format("{}.{:03} ms", time_us / 1000, time_us % 1000);
}

void Dut::fail(std::string expected, std::string got, std::vector<EntryAddress> failed_entries) {
  failed_ = mark();
  throw CaseEnd{Verdict::failed, {}, std::move(expected), std::move(got), {}, std::move(failed_entries)};
}
void Dut::fail_by_sheet(AnyRule rule, std::string expected, std::string got) {
  failed_ = mark();
  throw CaseEnd{Verdict::failed, {}, std::move(expected), std::move(got), rule};
}
void Dut::not_applicable(std::string reason) { throw CaseEnd{Verdict::not_applicable, std::move(reason), {}, {}}; }
void Dut::inconclusive(std::string reason) { throw CaseEnd{Verdict::inconclusive, std::move(reason), {}, {}}; }

void Dut::need_part(std::string_view name) {
  if (std::ranges::find(settings_.omitted, name) == settings_.omitted.end()) return;
  not_applicable(fmt::format("the composition of the program omits it: canopen::without<canopen::part::{}>", name));
}

void Dut::need_permission(Permission permission) {
  for (const PermissionRow& row : permission_options) {
    if (includes(permission, row.permission) && !allowed(row.permission)) {
      inconclusive(fmt::format("needs {}", row.option));
    }
  }
}

void Dut::expect_abort(const SdoOutcome& outcome, const AbortRule& rule, const std::string& what) {
  const std::string where = what.empty() ? "" : what + ": ";
  const std::string expected = where + "an abort with " + abort_text(rule.standard.front());
  if (outcome.end != SdoEnd::refused || !rule.is_accepted(outcome.code)) fail(expected, where + outcome_text(outcome));
  if (!rule.is_standard(outcome.code)) {
    warn(fmt::format("{}{}; CiA 301 has {}", where, abort_text(outcome.code), abort_text(rule.standard.front())));
  }
}

void Dut::expect_abort(const std::optional<sdo::Data>& data, const AbortRule& rule, const std::string& what) {
  SdoOutcome outcome;
  outcome.end = !data ? SdoEnd::no_answer : SdoEnd::done;
  if (data && (*data)[0] == sdo::abort_command) {
    transfer_open_ = false;
    outcome.end = SdoEnd::refused;
    outcome.code = canopen::abort_code_from(sdo::word_of(*data));
  } else if (data) {
    outcome.bytes.assign(data->begin(), data->end());
  }
  expect_abort(outcome, rule, what);
}

void Dut::expect_done(const SdoOutcome& outcome, const std::string& what) {
  expect(outcome.done(), what, outcome_text(outcome));
}

void Dut::expect_equal(std::uint64_t got, std::uint64_t expected, const std::string& what) {
  expect(got == expected, fmt::format("{}: {} ({:X}h)", what, expected, expected), fmt::format("{} ({:X}h)", got, got));
}

void Dut::expect_time(std::uint64_t measured, std::uint64_t low, std::uint64_t high, const std::string& what) {
  const std::uint64_t wider = tolerance().count();
  if (measured + wider >= low && measured <= high + wider) return;
  const std::uint64_t misses = measured < low ? low - measured : measured - high;
  if (misses <= lag_ + settings_.tolerance.count()) {
    inconclusive(fmt::format("{}: measured {}, but the test itself was late by {}", what, milliseconds_text(measured),
                             milliseconds_text(lag_)));
  }
  fail(fmt::format("{}: {} to {}", what, milliseconds_text(low), milliseconds_text(high)), milliseconds_text(measured));
}

Duration Dut::tolerance() const { return settings_.tolerance; }

}  // namespace edsc::conform
