/// Devices in simulated time for simulated_test.py and simulated_port_test.cpp.
#include <array>
#include <canopen_sim/simulated_device.hpp>
#include <cstdint>
#include <cstdio>
#include <every_service/device.hpp>
#include <live_device/device.hpp>
#include <scaled_drive/device.hpp>
#include <tuple>

namespace od = live_device::od;

namespace {

/// Moves with the target velocity, in increments per millisecond, up to the maximum speed.
class Motor {
 public:
  void start(auto& node) {
    using namespace canopen::literals;
    static_cast<void>(node.set(od::producer_heartbeat_time{}, 500_ms));
  }
  canopen::AbortCode write(od::target_velocity, od::target_velocity::type velocity, auto& node) {
    if (velocity.raw() > node.get(od::maximum_speed{}).raw()) return canopen::AbortCode::value_too_high;
    std::printf("velocity %d\n", static_cast<int>(velocity.raw()));  // not on the standard output of the protocol
    velocity_ = velocity.raw();
    return canopen::ok;
  }
  void every(canopen::Milliseconds<1>, auto& node) {
    if (node.now().since_start().count() % 1000 != 0)
      std::printf("call at %u\n", static_cast<unsigned>(node.now().since_start().count()));
    const std::int32_t position = node.get(od::position_actual_value{}).raw() + velocity_;
    static_cast<void>(node.set(od::position_actual_value{}, canopen::raw(position)));
  }

 private:
  std::int32_t velocity_ = 0;
};

constexpr std::array<canopen::SimulatedDevice, 4> devices = {{
    {"live", &canopen::make_simulated_node<live_device::Device>},
    {"motor", &canopen::make_simulated_node<live_device::Device, Motor>},
    {"scaled_drive", &canopen::make_simulated_node<scaled_drive::Device>},
    {"every_service", &canopen::make_simulated_node<every_service::Device>},
}};

}  // namespace

int main(int argc, char** argv) { return canopen::simulate_devices(argc, argv, devices); }
