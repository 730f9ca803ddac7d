/// The master of two drives: it boots them, follows their positions by PDO, and learns of an error by EMCY.
#include <canopen/master.hpp>
#include <canopen_sim/virtual_bus.hpp>
#include <canopen_sim/virtual_bus_port.hpp>
#include <cpc_tc1/device.hpp>
#include <cstdint>
#include <cstdio>
#include <map>

#include "motor.hpp"

namespace od = cpc_tc1::od;
using canopen::NodeId;
using Drive = canopen::cia402::DriveNode<ServoParts, canopen::VirtualBus::Endpoint, Motor>;
using command = od::controlword::type::command_value;

int main() {
  canopen::VirtualBus bus{500'000};
  auto &first_port = bus.attach(), &second_port = bus.attach();
  Drive first{first_port, NodeId{5}}, second{second_port, NodeId{6}};
  bus.connect(first_port, first);
  bus.connect(second_port, second);
  first.start(bus.now());
  second.start(bus.now());

  using namespace canopen::slave_assignment;
  canopen::VirtualBusPort port{bus};
  canopen::Master master{port,
                         {{.node_id = NodeId{5}, .assignment = listed | boot | mandatory, .heartbeat_time = 300},
                          {.node_id = NodeId{6}, .assignment = listed | boot | mandatory, .heartbeat_time = 300}}};
  master.on_booted = [](NodeId node, const canopen::BootResult& result) {
    std::printf("%s\n", boot_text(node, result).c_str());
  };
  std::map<int, unsigned> errors;
  master.on_emergency = [&](NodeId node, const canopen::EmergencyMessage& emergency) {
    errors[node.value()] = emergency.code;
    std::printf("node %d: EMCY %04Xh\n", node.value(), unsigned{emergency.code});
  };
  master.start();
  master.poll(canopen::from_milliseconds(2'000));

  std::map<int, std::int32_t> positions;
  for (const int id : {5, 6}) {
    auto drive = master.remote<cpc_tc1::Device>(NodeId{static_cast<std::uint8_t>(id)});
    const auto listening = drive.on_pdo<cpc_tc1::Tpdo2>(
        [&positions, id](auto /*statusword*/, std::int32_t position) { positions[id] = position; });
    if (!listening || !drive.write(od::controlword{}, od::controlword::type{}.command(command::shutdown))) return 1;
  }
  first.axis().set_position(1'000);
  second.fault(0x2310, canopen::ErrorRegister::current, bus.now());
  if (!master.send_sync()) return 2;
  master.poll(canopen::from_milliseconds(100));
  return positions[5] == 1'000 && errors[6] == 0x2310 && !errors.contains(5) ? 0 : 3;
}
