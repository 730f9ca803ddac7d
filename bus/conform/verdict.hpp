/// Results of a case and of a run, as reports show them.
#pragma once

#include <canopen/base/abort_code.hpp>
#include <canopen/base/clock.hpp>
#include <canopen/can/frame.hpp>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "conform/case.hpp"
#include "lookup/find_entry.hpp"
#include "online/simulated_port.hpp"
#include "rules/rule.hpp"

namespace edsc::conform {

enum class Verdict : std::uint8_t {
  passed,
  failed,
  not_applicable,  ///< the EDS does not have what the case tests, or the program of the device omits it
  deviates,        ///< failed, as the file of deviations declares
  inconclusive,    ///< no result: a condition of the case does not hold, or a repetition has another verdict
  not_run,         ///< the run may not do what the case needs
};

struct VerdictRow {
  Verdict verdict;
  std::string_view name;  ///< in JSON
  std::string_view text;  ///< in reports
};

inline constexpr VerdictRow verdicts[] = {
    {Verdict::passed, "passed", "passed"},
    {Verdict::failed, "failed", "failed"},
    {Verdict::not_applicable, "not_applicable", "not applicable"},
    {Verdict::deviates, "deviates", "deviates as declared"},
    {Verdict::inconclusive, "inconclusive", "inconclusive"},
    {Verdict::not_run, "not_run", "not run"},
};

[[nodiscard]] constexpr const VerdictRow& row_of(Verdict verdict) {
  return verdicts[static_cast<std::size_t>(verdict)];
}

/// A frame on the bus while a case ran.
struct SeenFrame {
  canopen::Frame frame;
  std::uint64_t at = 0;  ///< microseconds since the run began
  bool sent = false;     ///< by the test
};

/// A write through the default SDO that the device has refused.
struct RefusedWrite {
  std::uint16_t index = 0;
  std::uint8_t sub_index = 0;
  canopen::AbortCode code{};

  friend bool operator==(const RefusedWrite&, const RefusedWrite&) = default;
};

/// A failure that a repetition of the case did not confirm.
struct FirstRun {
  std::string expected;
  std::string got;
  std::vector<SeenFrame> frames;                ///< until the failure
  std::vector<std::size_t> failed_frames = {};  ///< positions in `frames`, as in CaseResult
};

struct CaseResult {
  const CaseRow* row = nullptr;
  Verdict verdict = Verdict::passed;
  std::string reason;                        ///< why it neither passed nor failed: `1017h:00 does not exist in the EDS`
  Condition condition = Condition::none;     ///< that does not hold, of an inconclusive case
  std::optional<FirstRun> first_run;         ///< of a case whose repetition has another verdict
  std::string expected;                      ///< of a failure: `0609 0011h, sub-index does not exist`
  std::string got;                           ///< of a failure: `no answer within 500 ms`
  RuleId rule;                               ///< of `edsc check`, if an error in the EDS is the cause of the failure
  std::vector<EntryAddress> failed_entries;  ///< all that failed, of a case that tries many; else empty
  std::vector<std::string> warnings;         ///< accepted differences from CiA 301
  std::vector<SeenFrame> frames;
  std::optional<std::size_t> until_failure;  ///< number of frames before it; the others restore values
  std::vector<std::size_t> failed_frames;    ///< positions of the frames that the failed check names, ascending
  std::vector<RefusedWrite> refused_writes;  ///< of a failure that consists of refused writes
  std::string deviation;                     ///< the reason in the file of deviations
  std::vector<std::string> not_restored;     ///< changed by the case and could not be restored
  std::uint64_t began = 0;                   ///< microseconds since the run began
  std::uint64_t took = 0;                    ///< microseconds
  std::uint64_t lag = 0;                     ///< maximum lag of the test itself, microseconds

  /// The frames on which the verdict is based.
  [[nodiscard]] std::span<const SeenFrame> verdict_frames() const {
    return std::span{frames}.first(until_failure.value_or(frames.size()));
  }
};

/// Failed cases with one cause.
struct Cause {
  std::string text;  ///< the failure of the first case, or the rule of `edsc check`
  std::vector<const CaseResult*> cases;
};

/// Inconclusive cases that rely on the same condition, for the same reason.
struct MissingCondition {
  Condition condition;
  std::string reason;
  std::vector<const CaseResult*> cases;
};

/// A file that a run uses.
struct InputFile {
  std::string path;  ///< as it was given or found; empty: there is none
  std::string hash;  ///< SHA-256, hexadecimal digits; empty if the file cannot be read again, such as standard input
};

/// The results of a run, as its reports show them.
struct RunReport {
  std::string title;          ///< of the report, as the user gives it; may be empty
  std::string operator_name;  ///< the person who tests; may be empty
  std::string place;          ///< where; may be empty
  std::string host;           ///< name of the computer of the test
  std::int64_t started = 0;   ///< seconds since 1970-01-01 00:00 UTC; 0: not known
  std::string bus;            ///< the address
  std::uint8_t node = 0;
  std::string sheet;       ///< path as it was given
  std::string options;     ///< path of the options file if it was given
  std::string sheet_hash;  ///< SHA-256 of the file, hexadecimal digits
  InputFile options_file;  ///< that was used: the one that was given, or the one beside the EDS
  InputFile deviations_file;
  std::string product, vendor;                 ///< as in the EDS
  std::string identity;                        ///< differences from the EDS; empty: none
  std::vector<EntryAddress> identity_entries;  ///< the entries of the numbers that differ
  std::string identity_deviation;              ///< why all of them are declared; empty: they are not
  std::string read_identity;                   ///< as read from the device: `vendor-ID 0000 0319h, product code ...`
  std::optional<SimulatedComposition> composition;  ///< of a simulated device
  Level level = Level::read;
  Permission permissions = Permission::none;
  bool force = false;  ///< also a device with another vendor-ID or product code than the EDS is written
  std::uint32_t seed = 0;
  std::string version;  ///< of edsc
  std::vector<CaseResult> cases;
  std::vector<SeenFrame> frames;               ///< of the whole run, also between cases
  std::vector<std::string> unused_deviations;  ///< declared, but the case passed: an error
  std::vector<std::string> not_restored;       ///< at the end of the run
  bool interrupted = false;
  std::string lost;  ///< why the run ended early: the bus is lost, or the device does not respond

  [[nodiscard]] std::size_t count(Verdict verdict) const;
  /// The causes of the failed cases, in the order of their first case.
  [[nodiscard]] std::vector<Cause> causes() const;
  /// The conditions that did not hold, in the order of their first case.
  [[nodiscard]] std::vector<MissingCondition> missing_conditions() const;
  /// Cases ran and none failed, no deviation is unused, all values are restored and the run is complete.
  [[nodiscard]] bool passed() const;
};

/// The command that runs a case alone: `edsc conform BUS NODE FILE --only 2.5`, with the options that it needs.
[[nodiscard]] std::string repeat_command(const RunReport& run, const CaseRow& row);

}  // namespace edsc::conform
