/// A pump on a simulated bus: a master starts it and sends a speed, the pump answers with its pressure.
#include <canopen_sim/virtual_bus.hpp>
#include <cstdio>

#include "pump.hpp"

using namespace canopen::literals;

int main() {
  canopen::VirtualBus bus;
  auto& port = bus.attach();
  auto& master = bus.attach();
  master.on_frame = [](const canopen::Frame& frame, canopen::TimePoint) {
    if (frame.id == 0x185) {
      const auto pressure = pump::Tpdo1::get<od::pressure>(frame);
      std::printf("pressure %.3f bar\n", pressure.in<canopen::unit::bar>());
    }
  };

  canopen::Node<PumpParts, canopen::VirtualBus::Endpoint> node{port, canopen::NodeId{5}};
  bus.connect(port, node);

  node.start(bus.now());
  master.send({.id = 0x000, .size = 2, .data = {0x01, 0x05}});                                  // NMT: start node 5
  master.send({.id = 0x205, .size = pump::Rpdo1::size, .data = pump::Rpdo1::pack(1'680_rpm)});  // RPDO 1
  bus.settle();
  return node.get(od::pressure{}) == 0.42_bar ? 0 : 1;
}
