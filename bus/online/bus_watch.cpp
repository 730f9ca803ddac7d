#include "online/bus_watch.hpp"

#include <canopen/can/cob_id.hpp>
#include <canopen/nmt/error_control.hpp>
#include <canopen/sdo/sdo_protocol.hpp>

namespace edsc {

BusWatch::BusWatch(LiveBus& bus) : bus_{bus} {
  bus.on_frame = [this](const canopen::Frame& frame, canopen::TimePoint) {
    count_command(frame);
    count(frame);
  };
  bus.on_sent = [this](const canopen::Frame& frame, canopen::TimePoint) { count(frame); };
}

BusWatch::~BusWatch() {
  bus_.on_frame = nullptr;
  bus_.on_sent = nullptr;
}

void BusWatch::count_command(const canopen::Frame& frame) {
  constexpr std::uint8_t nmt_size = 2;
  if (frame.id != canopen::function_code::nmt || frame.extended || frame.remote || frame.size != nmt_size) return;
  if (const std::uint8_t node_id = frame.data[1]; node_id < counts_.size()) ++counts_[node_id].foreign_commands;
}

void BusWatch::count(const canopen::Frame& frame) {
  if (const auto message = canopen::error_control_message(frame)) {
    if (message->state == canopen::NmtState::initialisation) ++counts_[message->node_id.value()].boot_ups;
    return;
  }
  if (frame.extended || frame.remote || frame.size != 8) return;
  constexpr std::uint32_t node_id_bits = 0x7F;
  Counts& counts = counts_[frame.id & node_id_bits];
  switch (frame.id & ~node_id_bits) {
    case canopen::function_code::sdo_request:
      if (frame.data[0] != canopen::sdo::abort_command) ++counts.requests;
      break;
    case canopen::function_code::sdo_response:
      if (counts.requests != 0) ++counts.responses;
      break;
    default: break;
  }
}

}  // namespace edsc
