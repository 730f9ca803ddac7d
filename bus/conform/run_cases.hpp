/// Runs the cases of the conformance test on one device.
#pragma once

#include <cstddef>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "conform/case.hpp"
#include "conform/dut/dut.hpp"
#include "conform/verdict.hpp"

namespace edsc::conform {

struct RunSettings {
  DutSettings dut;
  bool force = false;             ///< also writes a device with another vendor-ID or product code than the EDS
  std::vector<std::string> only;  ///< patterns such as `3.*`; empty: all cases
  /// Before each case.
  std::function<void(const CaseRow& row, std::size_t done, std::size_t of)> began = [](const CaseRow&, std::size_t,
                                                                                       std::size_t) {};
  /// After each case. May change the result in the report.
  std::function<void(CaseResult& result)> ended = [](CaseResult&) {};
};

/// The run is too dangerous for this device. Nothing was written.
struct RunRefused : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Runs the cases and fills the report, except for what identifies the EDS, the bus and edsc. An interruption or a lost
/// bus ends the run; before, the values of the device are restored as far as possible. Throws RunRefused.
void run_cases(LiveBus& bus, const Device& sheet, Stimuli& stimuli, const RunSettings& settings, RunReport& report);

}  // namespace edsc::conform
