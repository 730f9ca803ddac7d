/// The pump of the README with a sensor: its pressure changes every 10 ms, without an event on the bus.
/// `sensor_pump BUS` is node 5 until it is killed.
#include <canopen/host/host_bus.hpp>
#include <canopen/node.hpp>
#include <cstdint>
#include <cstdio>
#include <pump/device.hpp>

namespace od = pump::od;

namespace {

class Pump {
 public:
  void written(od::speed_setpoint, od::speed_setpoint::type speed, auto& node) {
    pressure_ = static_cast<std::uint16_t>(speed.raw() / 4);
    node.set(od::pressure{}, canopen::raw(pressure_));
  }
  void every(canopen::Milliseconds<10>, auto& node) {
    ripple_ = static_cast<std::uint16_t>((ripple_ + 3) % 17);
    node.set(od::pressure{}, canopen::raw(static_cast<std::uint16_t>(pressure_ + ripple_)));
  }

 private:
  std::uint16_t pressure_ = 0, ripple_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return 2;
  canopen::HostBus bus{argv[1]};
  canopen::Node<canopen::Composition<pump::Device, Pump>, canopen::HostBus> node{bus, canopen::NodeId{5}};
  std::puts("started");
  std::fflush(stdout);
  bus.run(node);
}
