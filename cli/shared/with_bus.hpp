/// A command at a live bus.
#pragma once

#include <functional>
#include <string>

#include "online/live_bus.hpp"

namespace edsc {

/// Opens the bus and runs a command on it. What goes wrong on the way is told on standard error. Throws as the
/// constructor of LiveBus does.
[[nodiscard]] int with_bus(const std::string& address, const std::function<int(LiveBus&)>& command);

}  // namespace edsc
