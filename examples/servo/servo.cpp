/// A servo drive of CiA 402 with its motor; a master enables it and reads its statusword.
#include <canopen/host/virtual_bus.hpp>
#include <canopen/host/virtual_bus_port.hpp>
#include <canopen/master.hpp>
#include <cpc_tc1/device.hpp>
#include <cstdint>
#include <cstdio>

#include "motor.hpp"

namespace od = cpc_tc1::od;
using canopen::cia402::State;

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

  for (const int controlword : {0x06, 0x07, 0x0F}) {  // shutdown, switch on, enable operation
    if (!remote.write(od::controlword{}, controlword)) return 2;
    const auto status = remote.read(od::statusword{});
    std::printf("controlword %02Xh: statusword %04Xh\n", unsigned(controlword), unsigned{status.value()});
  }
  if (drive.drive().state() != State::operation_enabled || !drive.axis().powered) return 3;

  drive.fault(0x2310, canopen::ErrorRegister::current, bus.now());  // the hardware reports an overcurrent
  master.poll(canopen::from_milliseconds(10));
  const auto status = remote.read(od::statusword{});
  std::printf("overcurrent: statusword %04Xh, 1001h %02Xh\n", unsigned{status.value()},
              unsigned{remote.read(od::error_register{}).value()});
  return drive.drive().state() == State::fault && !drive.axis().powered ? 0 : 4;
}
