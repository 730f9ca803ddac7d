#include "audit/network_times.hpp"

#include <algorithm>
#include <canopen/can/cob_id.hpp>
#include <canopen/sdo/sdo_transfer.hpp>
#include <chrono>

#include "network/cob_id_use.hpp"

namespace edsc::audit {
namespace {

double microseconds(Nanoseconds time) { return static_cast<double>(time.count()) / 1000; }

/// Whether the period of the message is its longest distance: a heartbeat, SYNC, or a PDO by SYNC or event timer.
bool has_longest_distance(const TimedMessage& message, const std::vector<CobIdUse>& uses) {
  if (message.message.remote) return false;
  if (message.service == FrameService::sync || message.service == FrameService::error_control) return true;
  const auto use = std::ranges::find_if(uses, [&](const CobIdUse& one) {
    return one.service == FrameService::pdo && one.transmits && one.can_id == message.message.can_id &&
           one.extended == message.message.extended;
  });
  if (use == uses.end()) return false;
  const auto longest = longest_interval(*use, uses);
  return longest && *longest == message.message.period;
}

}  // namespace

std::optional<double> MeasuredMessage::response_us() const {
  if (computed.is_synchronous) {
    return after_sync.count() == 0 ? std::nullopt : std::optional{static_cast<double>(after_sync.max())};
  }
  if (!is_cyclic || distance.count() == 0) return std::nullopt;
  const double late = static_cast<double>(distance.max()) - microseconds(computed.message.period);
  return std::max(late, 0.0) + microseconds(computed.response.transmission);
}

std::optional<bool> MeasuredMessage::is_within_bound() const {
  const auto measured = response_us();
  if (!measured || !computed.response.worst) return std::nullopt;
  return *measured <= microseconds(*computed.response.worst);
}

NetworkTimes::NetworkTimes(const Network& network) : network_{&network} {
  const std::vector<CobIdUse> uses = cob_id_uses(network);
  NetworkTiming timing = network_timing(network, uses);
  load_ = timing.load;
  for (TimedMessage& one : timing.messages) {
    const bool cyclic = has_longest_distance(one, uses);
    const bool is_sdo = one.service == FrameService::sdo;
    // One bound is for all SDOs: one request and one response at a time in the whole network.
    if (!is_sdo && !one.message.remote) {
      places_.emplace(cob_id_of(one.message.can_id, one.message.extended), messages_.size());
    }
    messages_.push_back({.computed = std::move(one), .is_cyclic = cyclic});
  }
  if (const CobIdUse* const sync = sync_producer(uses)) sync_ = cob_id_of(sync->can_id, sync->extended);
  constexpr canopen::SdoClientOptions master;  // of the generated one
  for (const NetworkNode& node : network.nodes) {
    const auto timeout = sdo_timeout_ms(network.description, *node.description);
    servers_.push_back({.name = node.name,
                        .node_id = node.node_id,
                        .timeout_us = timeout ? std::int64_t{*timeout} * 1000 : master.timeout.count()});
  }
}

void NetworkTimes::see_sdo(const SeenMessage& seen) {
  const Message& message = seen.message;
  if (message.channel >= asked_us_.size()) return;
  std::optional<std::int64_t>& asked = asked_us_[message.channel];
  if (message.from_client) {
    asked = seen.at.us;
    return;
  }
  if (!asked) return;
  const auto server = std::ranges::find(servers_, message.node_id, &MeasuredServer::node_id);
  if (server != servers_.end()) server->response.add(seen.at.us - *asked);
  asked.reset();
}

void NetworkTimes::see(const SeenMessage& seen) {
  if (!seen.at.has_time) return;
  const Message& message = seen.message;
  if (message.service == Service::nmt || message.service == Service::boot_up) changed_us_ = seen.at.us;
  if (message.service == Service::sdo) return see_sdo(seen);
  const std::uint32_t cob_id = canopen::cob_id_of(seen.frame);
  if (sync_ == cob_id) sync_us_ = seen.at.us;
  const auto place = places_.find(cob_id);
  if (place == places_.end() || seen.frame.remote || message.service == Service::boot_up) return;
  MeasuredMessage& measured = messages_[place->second];
  ++measured.frames;
  if (measured.last_us && *measured.last_us > changed_us_) measured.distance.add(seen.at.us - *measured.last_us);
  measured.last_us = seen.at.us;
  if (measured.computed.is_synchronous && sync_us_ && *sync_us_ > changed_us_) {
    measured.after_sync.add(seen.at.us - *sync_us_);
  }
}

}  // namespace edsc::audit
