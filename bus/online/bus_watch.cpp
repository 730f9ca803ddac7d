#include "online/bus_watch.hpp"

#include <canopen/can/cob_id.hpp>
#include <canopen/nmt/error_control.hpp>
#include <canopen/sdo/sdo_protocol.hpp>

namespace edsc {

BusWatch::BusWatch(LiveBus& bus) : bus_{bus} {
  const auto observe = [this](const canopen::Frame& frame, canopen::TimePoint) { count(frame); };
  bus.on_frame = observe;
  bus.on_sent = observe;
}

BusWatch::~BusWatch() {
  bus_.on_frame = nullptr;
  bus_.on_sent = nullptr;
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
