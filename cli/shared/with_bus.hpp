/// Runs a command on a live bus.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "online/live_bus.hpp"

namespace edsc {

/// Opens the bus and runs a command on it. Reports a problem on standard error. Throws the exceptions of the LiveBus
/// constructor.
[[nodiscard]] int with_bus(const std::string& address, const std::function<int(LiveBus&)>& command);

/// The same on another port. `name`: of the bus, in messages.
[[nodiscard]] int with_bus(std::unique_ptr<BusPort> port, const std::string& name,
                           const std::function<int(LiveBus&)>& command);

}  // namespace edsc
