/// An analogue output module, four channels of -10 V to +10 V.
#pragma once

#include <can_2024c/device.hpp>
#include <canopen/can/frame.hpp>
#include <canopen/can/node_id.hpp>

#include "shared/description.hpp"
#include "shared/io_module.hpp"

template <canopen::Bus B>
class Can2024c : public nodes::IoModule<can_2024c::Device, B> {
 public:
  static constexpr nodes::Description description{
      "can_2024c", "An analogue output module, four channels of -10 V to +10 V.", "3",
      "  switches TENS UNITS              the node-ID from the next power-on: switches 3 2\n"
      "  fault NAME | fault over          can-controller, eeprom, rx-buffer or tx-buffer: its EMCY\n",
      99};  // two rotary switches

  Can2024c(B& bus, nodes::Surroundings& around)
      : nodes::IoModule<can_2024c::Device, B>{bus, around, canopen::NodeId{3}} {}
};
