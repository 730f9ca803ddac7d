/// EMCY, continued: the error history 1003h with more than one error (CiA 301, 7.5.2.4).
#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "conform/case.hpp"
#include "conform/cases/nmt/heartbeat_source.hpp"
#include "conform/cases/pdo/tested_rpdo.hpp"
#include "conform/cases/shared/setup.hpp"

namespace edsc::conform {
namespace {

using Codes = std::vector<std::uint16_t>;

constexpr std::uint16_t no_error = canopen::emergency_code::reset;

std::string codes_text(const Codes& codes) {
  std::string text;
  for (const std::uint16_t code : codes) text += fmt::format("{}{:04X}h", text.empty() ? "" : ", ", code);
  return text.empty() ? "none" : text;
}

/// The emergency error codes of 1003h, the newest first. A device may record the end of an error as well: 0000h.
Codes recorded_codes(Dut& dut) {
  Codes codes;
  const std::uint64_t count = dut.read_number(error_history);
  for (std::uint8_t i = 1; i <= count && dut.has(error_history, i); ++i) {
    const auto code = static_cast<std::uint16_t>(dut.read_number(error_history, i) & 0xFFFF);
    if (code != no_error) codes.push_back(code);
  }
  return codes;
}

/// Causes two errors by frames, a short RPDO and a lost heartbeat, and calls `check` with the codes of the EMCYs, the
/// newest first. Inconclusive if the device does not report both, or if one ends: other cases test that.
template <class Check>
void with_two_errors(Dut& dut, Check check) {
  dut.need(error_history, 2);
  const std::uint32_t cob_id = emcy_cob_id(dut);
  constexpr Duration watched = milliseconds{200};
  dut.enter(NmtState::pre_operational);
  const HeartbeatSource source{dut};
  TestedRpdo rpdo{dut};
  source.watch(watched);
  dut.enter(NmtState::operational);
  const auto errors = [&] {
    const Dut::Mark since = dut.mark();
    rpdo.send(0);
    dut.pass_time(milliseconds{50});
    source.beat();
    dut.pass_time(watched * 2);
    Codes codes;
    for (const SeenFrame& seen : dut.received_since(since, Dut::with_cob_id(cob_id))) {
      if (seen.frame.size == 8) codes.insert(codes.begin(), emergency_code_of(seen.frame));
    }
    if (codes.size() < 2 || std::ranges::find(codes, no_error) != codes.end()) {
      dut.inconclusive(Condition::stimulus, fmt::format("a short RPDO and a lost heartbeat do not cause two EMCYs, but "
                                                        "{}",
                                                        codes_text(codes)));
    }
    check(codes);
  };
  and_undo(errors, [&] { end_errors(dut); });
}

void newest_first(Dut& dut) {
  with_two_errors(dut, [&dut](const Codes& sent) {
    const Codes recorded = recorded_codes(dut);
    const bool is_equal = recorded.size() >= sent.size() && std::equal(sent.begin(), sent.end(), recorded.begin());
    dut.expect(is_equal, fmt::format("1003h has the codes of the EMCYs, the newest first: {}", codes_text(sent)),
               codes_text(recorded));
  });
}

void deleted_by_zero(Dut& dut) {
  if (!dut.is_writable(error_history)) dut.not_applicable("1003h:00 is not writable in the EDS");
  with_two_errors(dut, [&dut](const Codes&) {
    if (dut.read_number(error_history) == 0) dut.inconclusive("1003h does not record the errors: case 5.6");
    const std::uint8_t none = 0;
    dut.expect_done(dut.command(error_history, 0, {&none, 1}), "0 written to 1003h:00, which deletes the errors");
    dut.expect_equal(dut.read_number(error_history), 0, "1003h:00 after 0 was written");
    const SdoOutcome newest = dut.upload(error_history, 1);
    dut.expect(!newest.done() || number_of(newest.bytes) == 0, "no error in 1003h:01 after 0 was written to 1003h:00",
               outcome_text(newest));
  });
}

constexpr Permission permissions = Permission::outputs | Permission::store;

constexpr CaseRow emergency_history_rows[] = {
    {"5.108", "The error history 1003h has the newest error first", "CiA 301, 7.5.2.4", Level::communication,
     permissions, newest_first, Condition::state | Condition::stimulus | Condition::alone, "5.6"},
    {"5.109", "After errors a write of 0 to 1003h:00 deletes them", "CiA 301, 7.5.2.4", Level::communication,
     permissions, deleted_by_zero, Condition::state | Condition::stimulus | Condition::alone, "5.7"},
};

}  // namespace

std::span<const CaseRow> emergency_history_cases() { return emergency_history_rows; }

}  // namespace edsc::conform
