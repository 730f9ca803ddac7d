/// The acceptance report as JSON: all results, with the frames.
#pragma once

#include <string>

#include "accept/acceptance.hpp"

namespace edsc::accept {

/// An object in the format of docs/schema/accept.schema.json, with a line end.
[[nodiscard]] std::string json_report(const Acceptance& acceptance);

}  // namespace edsc::accept
