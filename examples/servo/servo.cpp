/// A servo drive of CiA 402 with its motor; a master enables it and reads its statusword.
#include <canopen/master.hpp>
#include <canopen_sim/virtual_bus.hpp>
#include <canopen_sim/virtual_bus_port.hpp>
#include <cpc_tc1/device.hpp>
#include <cpc_tc1/meaning_text.hpp>
#include <cstdio>
#include <string>

#include "motor.hpp"

namespace od = cpc_tc1::od;
using command = od::controlword::type::command_value;
using state = od::statusword::type::state_value;

/// A command to the drive, and the state that it leads to.
struct Step {
  command given;
  state reached;
};
constexpr Step steps[] = {
    {command::shutdown, state::ready_to_switch_on},
    {command::switch_on, state::switched_on},
    {command::enable_operation, state::operation_enabled},
};

int main() {
  canopen::VirtualBus bus{500'000};
  auto& port = bus.attach();
  canopen::cia402::DriveNode<ServoParts, canopen::VirtualBus::Endpoint, Motor> drive{port, canopen::NodeId{5}};
  bus.connect(port, drive);
  drive.start(bus.now());

  canopen::VirtualBusPort master_port{bus};
  canopen::Master master{master_port};
  auto remote = master.remote<cpc_tc1::Device>(canopen::NodeId{5});
  if (!master.command(canopen::NmtCommand::start, canopen::NodeId{5})) return 1;

  for (const auto& [given, reached] : steps) {
    if (!remote.write(od::controlword{}, od::controlword::type{}.command(given))) return 2;
    const auto status = remote.read(od::statusword{});
    if (!status || !status->is(reached)) return 3;
    std::printf("%s: %s\n", std::string{to_text(given)}.c_str(), std::string{to_text(reached)}.c_str());
  }
  if (!drive.axis().powered) return 4;

  drive.fault(0x2310, canopen::ErrorRegister::current, bus.now());  // the hardware reports an overcurrent
  master.poll(canopen::from_milliseconds(10));
  const auto status = remote.read(od::statusword{});
  const auto errors = remote.read(od::error_register{});
  if (!status || !errors) return 5;
  std::printf("overcurrent: fault %d, current error %d\n", status->fault(), errors->current());
  return status->is(state::fault) && errors->current() && !drive.axis().powered ? 0 : 6;
}
