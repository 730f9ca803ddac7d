/// The name of this computer.
#pragma once

#include <string>

namespace edsc {

/// As the system knows it in a network; empty if it has none.
[[nodiscard]] std::string host_name();

}  // namespace edsc
