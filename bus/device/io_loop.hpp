/// The inputs of an I/O module of CiA 401 that its outputs are wired to.
#pragma once

#include <vector>

#include "device/behaviour.hpp"
#include "lookup/find_entry.hpp"

namespace edsc {

/// Returns a copy from each output to the input with the same size and number; empty if the device does not have both.
[[nodiscard]] std::vector<ValueCopy> io_loop(EntryFinder& names);

}  // namespace edsc
