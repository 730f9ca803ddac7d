/// The report of a run as JSON: all that the run has found out, with every frame.
#pragma once

#include <string>

#include "conform/verdict.hpp"
#include "device/device.hpp"

namespace edsc::conform {

/// An object as docs/schema/conform.schema.json says, with a line end.
[[nodiscard]] std::string json_report(const RunReport& run, const Device& sheet);

}  // namespace edsc::conform
