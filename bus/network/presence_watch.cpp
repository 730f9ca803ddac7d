#include "network/presence_watch.hpp"

#include <algorithm>
#include <canopen/can/cob_id.hpp>
#include <canopen/sdo/sdo_protocol.hpp>
#include <utility>

#include "network/cob_id_use.hpp"
#include "network/network.hpp"

namespace edsc {
namespace {

namespace code = canopen::function_code;

/// The upload of 1000h:00, which each node has.
canopen::Frame presence_request(std::uint8_t node_id) {
  canopen::Frame frame;
  frame.id = code::sdo_request + node_id;
  frame.size = 8;
  frame.data[0] = static_cast<std::uint8_t>(static_cast<unsigned>(canopen::sdo::ClientCommand::initiate_upload) << 5);
  canopen::sdo::put_multiplexer(frame.data, 0x1000, 0);
  return frame;
}

/// Whether a node sends such frames only when it is present. SYNC and TIME are of the network, not of a node.
bool shows_presence(const CobIdUse& use) {
  if (!use.transmits) return false;
  if (use.service == FrameService::sdo) return use.sdo == SdoFrames::responses;
  return use.service == FrameService::emcy || use.service == FrameService::pdo ||
         use.service == FrameService::error_control;
}

}  // namespace

std::size_t PresenceWatch::add(std::uint8_t node_id, std::set<std::uint32_t> cob_ids, canopen::Duration heartbeat) {
  Node node{};
  node.node_id = node_id;
  node.cob_ids = std::move(cob_ids);
  node.heartbeat = heartbeat;
  node.heard = start_;
  nodes_.push_back(std::move(node));
  return nodes_.size() - 1;
}

void PresenceWatch::on_frame(const canopen::Frame& frame, canopen::TimePoint now) {
  if (frame.remote) return;
  for (Node& node : nodes_) {
    if (node.cob_ids.contains(canopen::cob_id_of(frame))) {
      node.heard = now;
      node.is_asked = false;
      node.presence = Presence::present;
    } else if (!node.is_asked && !frame.extended && frame.id == code::sdo_request + std::uint32_t{node.node_id}) {
      node.asked = now;
      node.is_asked = true;
    }
  }
}

void PresenceWatch::on_time(canopen::TimePoint now, const std::function<bool(const canopen::Frame&)>& send) {
  for (Node& node : nodes_) {
    if (node.presence == Presence::absent) continue;
    const bool is_unknown = node.presence == Presence::unknown;
    const canopen::Duration quiet = quiet_time(node), since = now - node.heard;
    if (since < quiet) continue;
    if (!node.is_asked) {
      if (!send(presence_request(node.node_id))) continue;
      node.asked = now;
      node.is_asked = true;
    }
    const canopen::Duration answer = is_unknown ? absent_ - quiet : absent_;
    if (now - node.asked < answer || (is_unknown && since < absent_)) continue;
    node.presence = Presence::absent;
    node.is_asked = false;
  }
}

/// How long nothing is received from a node until it is asked: at the start half of the time, so that the other half is
/// for its answer.
canopen::Duration PresenceWatch::quiet_time(const Node& node) const {
  if (node.presence == Presence::unknown) return absent_ / 2;
  return std::max(absent_, 2 * node.heartbeat);
}

std::set<std::uint32_t> own_cob_ids(const Network& network, const NetworkNode& node) {
  std::set<std::uint32_t> own, others;
  for (const CobIdUse& use : cob_id_uses(network)) {
    const std::uint32_t cob_id = cob_id_of(use.can_id, use.extended);
    if (use.node == &node && shows_presence(use)) own.insert(cob_id);
    if (use.node != &node && use.transmits) others.insert(cob_id);
  }
  std::erase_if(own, [&](std::uint32_t cob_id) { return others.contains(cob_id); });
  return own;
}

}  // namespace edsc
