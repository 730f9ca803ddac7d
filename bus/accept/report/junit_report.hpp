/// The acceptance report as JUnit XML.
#pragma once

#include <string>

#include "accept/acceptance.hpp"

namespace edsc::accept {

/// The suites of the conformance test, after a suite each for `edsc check`, the identity and the dictionary. The suite
/// of the dictionary has a test for each object.
[[nodiscard]] std::string junit_report(const Acceptance& acceptance);

}  // namespace edsc::accept
