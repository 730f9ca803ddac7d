#include "shared/with_bus.hpp"

#include "online/interruption.hpp"
#include "shared/exit_code.hpp"
#include "text/printable.hpp"

namespace edsc {

int with_bus(const std::string& address, const std::function<int(LiveBus&)>& command) {
  const Interruption interruption;
  try {
    LiveBus bus{address};
    return command(bus);
  } catch (const BusLost& problem) {
    print_to_stderr("edsc: {}: the bus is lost: {}\n", address, problem.what());
    return exit_device_failed;
  } catch (const Interrupted&) {
    print_to_stderr("edsc: interrupted\n");
    return exit_interrupted;
  }
}

}  // namespace edsc
