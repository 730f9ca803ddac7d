/// The comparison of the dictionary of a device with its EDS as commands run it.
#pragma once

#include "accept/compare_dictionary.hpp"
#include "online/live_bus.hpp"
#include "shared/conformance_test.hpp"

namespace edsc {

/// Only reads. Shows the progress; the differences that the test declares as deviations are marked.
[[nodiscard]] accept::Comparison compare_dictionaries(LiveBus& bus, ConformanceTest& test);

}  // namespace edsc
