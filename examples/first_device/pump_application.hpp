/// The application of the pump: its pressure follows the speed.
#pragma once

#include <canopen/node.hpp>
#include <cstdint>
#include <pump/device.hpp>
#include <tuple>

class PumpApplication {
 public:
  auto handlers() {
    return std::tuple{
        // an SDO write or RPDO 1 with a new speed comes here
        canopen::on_write<pump::od::speed_setpoint>([](auto& node, std::uint16_t speed) {
          node.template set<pump::od::pressure>(static_cast<std::uint16_t>(speed / 4));  // TPDO 1 goes out
        }),
    };
  }
};
