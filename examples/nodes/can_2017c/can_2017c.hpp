/// An analogue input module, eight channels of -10 V to +10 V.
#pragma once

#include <can_2017c/device.hpp>
#include <canopen/can/frame.hpp>
#include <canopen/can/node_id.hpp>

#include "shared/description.hpp"
#include "shared/io_module.hpp"

template <canopen::Bus B>
class Can2017c : public nodes::IoModule<can_2017c::Device, B> {
 public:
  static constexpr nodes::Description description{
      "can_2017c", "An analogue input module, eight channels of -10 V to +10 V.", "4",
      "  analogue CHANNEL VOLTS           channel 1 to 8: analogue 2 5.0\n"
      "  switches TENS UNITS              the node-ID from the next power-on: switches 3 2\n"
      "  fault NAME | fault over          can-controller, eeprom, rx-buffer or tx-buffer: its EMCY\n",
      99};  // two rotary switches

  Can2017c(B& bus, nodes::Surroundings& around)
      : nodes::IoModule<can_2017c::Device, B>{bus, around, canopen::NodeId{4}} {}
};
