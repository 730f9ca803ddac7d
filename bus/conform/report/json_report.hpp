/// The report of a run as JSON: all results, with every frame.
#pragma once

#include <string>

#include "conform/verdict.hpp"
#include "device/device.hpp"

namespace edsc::conform {

/// An object in the format of docs/schema/conform.schema.json, with a line end.
[[nodiscard]] std::string json_report(const RunReport& run, const Device& sheet);

}  // namespace edsc::conform
