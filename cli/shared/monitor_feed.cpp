#include "shared/monitor_feed.hpp"

#include <string>
#include <string_view>

namespace edsc {

MonitorFeed::MonitorFeed(const GivenNodes& nodes, canopen::TimePoint now) : decoder_{nodes.known()}, elapsed_{now} {
  for (const auto& [node_id, node] : nodes.devices) state_.set_name(node_id, node.named.device.product_name);
  for (std::uint8_t node_id = 1; node_id <= 127; ++node_id) {
    if (const std::string_view name = nodes.labels.name(node_id); !name.empty()) {
      state_.set_name(node_id, std::string{name});
    }
  }
  state_.start(0);
}

const Message* MonitorFeed::add(const canopen::Frame& frame, canopen::TimePoint now) {
  elapsed_.advance(now);
  decoder_.decode({frame, true, now_us()}, message_);
  return state_.add(frame, message_, now_us()) ? &message_ : nullptr;
}

void MonitorFeed::pass(canopen::TimePoint now) {
  elapsed_.advance(now);
  state_.pass(now_us());
}

}  // namespace edsc
