/// Texts and numbers that all reports of a run have in common.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include "conform/verdict.hpp"

namespace edsc::conform {

/// `3 of 127 cases failed; 101 passed, 20 not applicable, 3 not run`
[[nodiscard]] std::string result_sentence(const RunReport& run);

/// The same, after the problem of the run if no case failed: `unused deviation: pump.json:4: case 8.4 passed: ...; none
/// of 127 cases failed; 26 passed`.
[[nodiscard]] std::string verdict_sentence(const RunReport& run);

/// How much of the test has run: `level read: 26 of 207 cases run`. Empty if each case ran or is not applicable.
[[nodiscard]] std::string coverage_text(const RunReport& run);

/// `18 failed cases, 5 causes`; empty without a failed case.
[[nodiscard]] std::string causes_sentence(const RunReport& run);

/// `2.20, 2.21, 2.24`
[[nodiscard]] std::string case_ids(const std::vector<const CaseResult*>& cases);

/// `remote frames: no remote frame was answered in this run...`
[[nodiscard]] std::string condition_text(const MissingCondition& missing);

/// The begin of the run, in local time with the offset from UTC: `2026-11-27 14:03:12 +0100`. Empty if not known.
[[nodiscard]] std::string local_time_text(const RunReport& run);
/// The same in UTC: `2026-11-27T13:03:12`.
[[nodiscard]] std::string utc_text(const RunReport& run);

/// The case failed at first, and a repetition has not confirmed that: what it had expected, and got.
[[nodiscard]] std::string first_run_text(const FirstRun& first);

/// `level communication with store and outputs`
[[nodiscard]] std::string level_text(const RunReport& run);

/// The composition of a simulated device: `made by edsc, with all parts that the EDS promises`, `of the program`, `of
/// the program, without LSS, storage`. Empty for a device on a bus.
[[nodiscard]] std::string composition_text(const RunReport& run);

/// The differences of the identity from the EDS, and the declared reason; empty: none.
[[nodiscard]] std::string identity_sentence(const RunReport& run);

/// Other reasons for which a run does not pass: unused deviations, values that could not be restored, an early end.
[[nodiscard]] std::vector<std::string> run_problems(const RunReport& run);

/// The number of cases of an area by verdict, in the order of `verdicts`.
struct AreaCount {
  const AreaRow* area = nullptr;
  std::array<std::size_t, std::size(verdicts)> of_verdict{};
  std::size_t cases = 0;
};
/// The areas with cases in this run, in the order of the run.
[[nodiscard]] std::vector<AreaCount> count_by_area(const RunReport& run);

/// The maximum lag of the test itself, in microseconds.
[[nodiscard]] std::uint64_t max_lag(const RunReport& run);

/// `store`, `outputs`: the options without their dashes.
[[nodiscard]] std::vector<std::string_view> permission_names(Permission permissions);

/// The result of a case in one line: `expected 0602 0000h...; got no answer`, `not applicable: 1017h:00 does not
/// exist...`.
[[nodiscard]] std::string message_of(const CaseResult& result);

/// Seconds since the run began: `12.003481`.
[[nodiscard]] std::string time_text(std::uint64_t microseconds);

/// A duration: `0.4 ms`, `1.204 s`.
[[nodiscard]] std::string duration_text(std::uint64_t microseconds);

}  // namespace edsc::conform
