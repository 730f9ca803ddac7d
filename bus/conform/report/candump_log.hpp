/// The frames of a run as a candump log, which `edsc decode` reads.
#pragma once

#include <string>

#include "conform/verdict.hpp"

namespace edsc::conform {

/// A line for each frame: `(12.003481) can0 605#4008100000000000`, with seconds since the run began. Remote frames are
/// `185#R8`.
[[nodiscard]] std::string candump_log(const RunReport& run);

}  // namespace edsc::conform
