#include "online/bus_watch.hpp"

#include <canopen/can/cob_id.hpp>
#include <canopen/nmt/error_control.hpp>
#include <canopen/sdo/sdo_protocol.hpp>

namespace edsc {

BusWatch::BusWatch(LiveBus& bus, canopen::Duration forgotten_after) : bus_{bus}, forgotten_after_{forgotten_after} {
  bus.on_frame = [this](const canopen::Frame& frame, canopen::TimePoint now) {
    count_command(frame);
    count(frame, now);
  };
  bus.on_sent = [this](const canopen::Frame& frame, canopen::TimePoint now) { count(frame, now); };
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

void BusWatch::count(const canopen::Frame& frame, canopen::TimePoint now) {
  if (const auto message = canopen::error_control_message(frame)) {
    Counts& counts = counts_[message->node_id.value()];
    if (message->state == canopen::NmtState::initialisation) {
      ++counts.boot_ups;
    } else if (!message->toggle) {
      counts.rate.report(message->state, now);
    }
    return;
  }
  if (frame.extended || frame.remote || frame.size != 8) return;
  constexpr std::uint32_t node_id_bits = 0x7F;
  Counts& counts = counts_[frame.id & node_id_bits];
  switch (frame.id & ~node_id_bits) {
    case canopen::function_code::sdo_request:
      counts.is_asked = true;
      counts.responses.on_request(frame.data, now, forgotten_after_);
      break;
    case canopen::function_code::sdo_response:
      if (counts.is_asked && counts.responses.on_response(frame.data)) counts.extra_responses = true;
      break;
    default: break;
  }
}

}  // namespace edsc
