#include "shared/with_bus.hpp"

#include <utility>

#include "online/interruption.hpp"
#include "shared/exit_code.hpp"
#include "text/printable.hpp"

namespace edsc {
namespace {

/// Runs a command on a bus that `open` opens.
template <class Open>
int run_on(const std::string& name, const std::function<int(LiveBus&)>& command, Open&& open) {
  const Interruption interruption;
  try {
    LiveBus bus = open();
    return command(bus);
  } catch (const BusLost& problem) {
    print_to_stderr("edsc: {}: the bus is lost: {}\n", name, problem.what());
    return exit_device_failed;
  } catch (const Interrupted&) {
    print_to_stderr("edsc: interrupted\n");
    return exit_interrupted;
  }
}

}  // namespace

int with_bus(const std::string& address, const std::function<int(LiveBus&)>& command) {
  return run_on(address, command, [&] { return LiveBus{address}; });
}

int with_bus(std::unique_ptr<BusPort> port, const std::string& name, const std::function<int(LiveBus&)>& command) {
  return run_on(name, command, [&] { return LiveBus{std::move(port)}; });
}

}  // namespace edsc
