/// Runs the cases of the conformance test at one device.
#pragma once

#include <cstddef>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "conform/case.hpp"
#include "conform/dut.hpp"
#include "conform/verdict.hpp"

namespace edsc::conform {

struct RunSettings {
  DutSettings dut;
  std::vector<std::string> only;  ///< patterns such as `3.*`; empty: all cases
  /// Before each case.
  std::function<void(const CaseRow& row, std::size_t done, std::size_t of)> began = [](const CaseRow&, std::size_t,
                                                                                     std::size_t) {};
  /// It may change the result, which is then in the report.
  std::function<void(CaseResult& result)> ended = [](CaseResult&) {};
};

/// The run would do what is dangerous with this device; nothing was written yet.
struct RunRefused : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Fills what a run finds out: `cases`, what was not put back, and why it ended early. An interruption and a lost bus end
/// it; the device is put back before, as far as it can be. Throws RunRefused.
void run_cases(LiveBus& bus, const Device& sheet, Stimuli& stimuli, const RunSettings& settings, RunReport& report);

}  // namespace edsc::conform
