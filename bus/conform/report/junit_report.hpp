/// The report of a run as JUnit XML, for continuous integration.
#pragma once

#include <string>

#include "conform/verdict.hpp"
#include "device/device.hpp"

namespace edsc::conform {

/// One testsuite per area. Cases that are not applicable, deviate as declared, are inconclusive or were not run are
/// skipped tests with the reason. The testsuite "run" has the failures of the run as a whole: an unused deviation,
/// values that could not be restored, an early end.
[[nodiscard]] std::string junit_report(const RunReport& run, const Device& sheet);

}  // namespace edsc::conform
