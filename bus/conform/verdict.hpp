/// What a case came to, and what a run reports of it.
#pragma once

#include <canopen/frame.hpp>
#include <canopen/time.hpp>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "conform/case.hpp"

namespace edsc::conform {

enum class Verdict : std::uint8_t {
  passed,
  failed,
  not_applicable,  ///< the data sheet does not have what the case asks about
  deviates,        ///< failed, as the file of deviations declares
  inconclusive,    ///< the test could not find out: a stimulus is missing, or its own computer was too slow
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

struct CaseResult {
  const CaseRow* row = nullptr;
  Verdict verdict = Verdict::passed;
  std::string reason;    ///< why it is none of passed and failed: `1017h:00 does not exist in the data sheet`
  std::string expected;  ///< of a failure: `0609 0011h, sub-index does not exist`
  std::string got;       ///< of a failure: `no answer within 500 ms`
  std::string rule;      ///< of `edsc check`: the data sheet promises what no device keeps; empty: it does not
  std::vector<std::string> warnings;  ///< what passes, but is not what CiA 301 says
  std::vector<SeenFrame> frames;
  std::optional<std::size_t> until_failure;  ///< how many frames came before it; the others put the device back
  std::string deviation;                ///< the reason that the file of deviations gives
  std::vector<std::string> not_put_back;  ///< what the case changed and could not put back
  std::uint64_t began = 0;              ///< microseconds since the run began
  std::uint64_t took = 0;               ///< microseconds
  std::uint64_t lag = 0;                ///< the longest that the test itself was late, microseconds

  /// The frames that the verdict is about.
  [[nodiscard]] std::span<const SeenFrame> judged_frames() const {
    return std::span{frames}.first(until_failure.value_or(frames.size()));
  }
};

/// A run as its reports show it.
struct RunReport {
  std::string bus;         ///< the address
  std::uint8_t node = 0;
  std::string sheet;       ///< path as it was given
  std::string sheet_hash;  ///< SHA-256 of the file, hexadecimal digits
  std::string product, vendor;  ///< that the data sheet names
  std::string identity;    ///< what differs from the data sheet; empty: nothing
  std::string read_identity;  ///< `vendor-ID 0000 0319h, product code ...` as read from the device
  Level level = Level::read;
  Permission permissions = Permission::none;
  std::uint32_t seed = 0;
  std::string version;     ///< of edsc
  std::vector<CaseResult> cases;
  std::vector<std::string> unused_deviations;  ///< declared, but the case did not fail: an error
  std::vector<std::string> not_put_back;       ///< at the end of the run
  bool interrupted = false;
  std::string lost;  ///< why the run ended early: the bus is lost, or the device does not answer

  [[nodiscard]] std::size_t count(Verdict verdict) const;
  /// Cases ran and none failed, no deviation is unused, nothing is left changed and the run reached its end.
  [[nodiscard]] bool passed() const;
};

/// How a case is run again alone: `edsc conform BUS NODE FILE --only 2.5`, with what it needs.
[[nodiscard]] std::string repeat_command(const RunReport& run, const CaseRow& row);

}  // namespace edsc::conform
