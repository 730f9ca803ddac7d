#include "decode/decoder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <canopen/can/cob_id.hpp>
#include <canopen/lss/lss_protocol.hpp>
#include <canopen/nmt/error_control.hpp>
#include <iterator>

#include "decode/lss_text.hpp"
#include "decode/pdo_frame.hpp"
#include "decode/predefined_set.hpp"
#include "decode/services.hpp"
#include "values/append.hpp"

namespace edsc {
namespace {

namespace function_code = canopen::function_code;

using canopen::CobId;
using canopen::Frame;
using Use = Decoder::Use;

constexpr std::size_t max_further_followers = 1024;

/// The pre-defined connection set: CAN-IDs with node-ID 0, and those of a node. PDOs need an EDS.
struct PredefinedUse {
  std::uint32_t function;
  Use of_all, of_node;
};

constexpr PredefinedUse predefined_uses[] = {
    {function_code::nmt, Use::nmt, Use::unknown},
    {function_code::sync, Use::sync, Use::emcy},
    {function_code::time, Use::time, Use::unknown},
    {function_code::sdo_response, Use::unknown, Use::sdo_response},
    {function_code::sdo_request, Use::unknown, Use::sdo_request},
    {function_code::error_control, Use::unknown, Use::error_control},
};

Use predefined_use(std::uint32_t can_id) {
  if (can_id == canopen::lss::request_id || can_id == canopen::lss::response_id) return Use::lss;
  for (const PredefinedUse& row : predefined_uses) {
    if (row.function == function_code_of(can_id)) return node_id_of(can_id) == 0 ? row.of_all : row.of_node;
  }
  return Use::unknown;
}

/// Whether no object can give another meaning to the CAN-ID: NMT, default SDO, error control, LSS.
bool is_fixed(Use use) {
  return use == Use::nmt || use == Use::lss || use == Use::sdo_request || use == Use::sdo_response ||
         use == Use::error_control;
}

/// `TPDO 2 of node 7`; nothing for CAN-IDs of other services.
std::string predefined_pdo_text(std::uint32_t can_id) {
  const auto pdo = predefined_pdo(can_id);
  return pdo ? fmt::format("{}PDO {} of node {}", pdo->transmit ? 'T' : 'R', pdo->number, pdo->node_id) : std::string{};
}

void decode_unknown(const Frame& frame, Message& message) {
  message.problem = true;
  message.text += "CAN-ID ";
  append_can_id(message.text, frame);
  message.text += "h is not used by any known node";
  if (frame.extended) return;
  if (const std::string pdo = predefined_pdo_text(frame.id); !pdo.empty()) {
    message.text += "; in the pre-defined connection set it is " + pdo;
  } else if (const char* reason = canopen::restriction_of(frame.id)) {
    message.text += std::string{"; restricted by CiA 301: "} + reason;
  }
}

void decode_lss(const Frame& frame, Message& message) {
  message.service = Service::lss;
  message.from_client = frame.id == canopen::lss::request_id;
  message.problem = !append_lss_text(message.text, frame, message.from_client);
}

}  // namespace

Decoder::Decoder(const std::vector<KnownNode>& nodes) : followers_(node_ids) {
  for (const KnownNode& node : nodes) {
    NodeModel model{node.node_id, *node.device, node.inhibit_time_unit};
    if (NodeModel* const same = model_of(node.node_id)) {
      *same = std::move(model);
    } else {
      nodes_.push_back(std::move(model));
    }
  }
  for (std::size_t id = 0; id < node_ids; ++id) followers_[id].node_id = static_cast<std::uint8_t>(id);
  find_routes();
}

NodeModel* Decoder::model_of(std::uint8_t node_id) {
  const auto found = std::ranges::find(nodes_, node_id, &NodeModel::node_id);
  return found == nodes_.end() ? nullptr : &*found;
}

const NodeModel* Decoder::find_model(std::uint8_t node_id) const {
  const auto found = std::ranges::find(nodes_, node_id, &NodeModel::node_id);
  return found == nodes_.end() ? nullptr : &*found;
}

// Use of CAN-IDs

Decoder::Route Decoder::predefined_route(const Frame& frame) {
  const Use use = frame.extended ? Use::unknown : predefined_use(frame.id);
  const auto node_id = node_id_of(frame.id);
  return {use, node_id, node_id};
}

void Decoder::add_route(CobId cob_id, Route route) {
  if (!cob_id.valid() || (!cob_id.extended() && is_fixed(predefined_use(cob_id.can_id())))) return;
  (cob_id.extended() ? extended_routes_[cob_id.can_id()] : routes_[cob_id.can_id()]).push_back(route);
}

void Decoder::add_sdo_server(const NodeModel& model, const SdoServerIds& ids) {
  const ServerKey key{model.node_id(), ids.request.value() & 0x3FFF'FFFF, ids.response.value()};
  auto found = further_followers_.find(key);
  if (found == further_followers_.end()) {
    if (further_followers_.size() >= max_further_followers) return;
    found = further_followers_.emplace(key, static_cast<std::uint16_t>(followers_.size())).first;
    followers_.push_back({model.node_id(), {}});
  }
  add_route(ids.request, {Use::sdo_request, model.node_id(), found->second});
  add_route(ids.response, {Use::sdo_response, model.node_id(), found->second});
}

void Decoder::find_routes() {
  for (auto& routes : routes_) routes.clear();
  extended_routes_.clear();
  // The sender comes first: the TPDO of one node is the RPDO of another.
  for (const PdoDirection direction : {PdoDirection::transmit, PdoDirection::receive}) {
    for (const NodeModel& model : nodes_) {
      for (std::size_t at = 0; at < model.pdos().size(); ++at) {
        const PdoLayout& pdo = model.pdos()[at];
        if (pdo.direction == direction) {
          add_route(pdo.cob_id, {Use::pdo, model.node_id(), static_cast<std::uint16_t>(at)});
        }
      }
    }
  }
  for (const NodeModel& model : nodes_) {
    add_route(model.sync(), {Use::sync, model.node_id()});
    add_route(model.time(), {Use::time, model.node_id()});
    add_route(model.emcy(), {Use::emcy, model.node_id()});
    for (const SdoServerIds& ids : model.further_sdo_servers()) add_sdo_server(model, ids);
  }
}

std::span<const Decoder::Route> Decoder::routes_of(const Frame& frame) const {
  if (!frame.extended) return routes_[frame.id & (can_ids - 1)];
  const auto found = extended_routes_.find(frame.id);
  return found == extended_routes_.end() ? std::span<const Route>{} : found->second;
}

// Frames

void Decoder::decode(const TimedFrame& timed, Message& message) {
  message.clear();
  const Frame& frame = timed.frame;
  const Route predefined = predefined_route(frame);
  std::span<const Route> routes = routes_of(frame);
  if (routes.empty()) routes = {&predefined, 1};
  const Route route = routes.front();
  switch (route.use) {
    case Use::unknown: return decode_unknown(frame, message);
    case Use::nmt: return decode_nmt(frame, message);
    case Use::sync: return decode_sync(frame, message);
    case Use::time: return decode_time(frame, message);
    case Use::emcy: {
      const NodeModel* const model = model_of(route.node_id);
      message.node_id = route.node_id;
      return decode_emcy(frame, model != nullptr ? &model->device() : nullptr, message);
    }
    case Use::error_control: return decode_error_control(frame, message);
    case Use::lss: return decode_lss(frame, message);
    case Use::sdo_request:
    case Use::sdo_response: return decode_sdo(timed, route.place, route.use == Use::sdo_request, message);
    case Use::pdo: return decode_pdo(frame, routes, message);
  }
}

void Decoder::decode_error_control(const Frame& frame, Message& message) {
  message.node_id = node_id_of(frame.id);
  message.service = Service::heartbeat;
  bool& asked = guarding_asked_[message.node_id];
  if (frame.remote) {
    message.service = Service::guarding;
    message.text += "state requested";
    asked = true;
    return;
  }
  if (frame.size != 1) return wrong_length(frame, "1", message);
  const bool was_asked = std::exchange(asked, false);
  const auto found = canopen::error_control_message(frame);
  if (!found) {
    fmt::format_to(std::back_inserter(message.text), "unknown state {}", frame.data[0] & 0x7F);
    message.problem = true;
    return;
  }
  message.state = found->state;
  if (found->state == canopen::NmtState::initialisation && !found->toggle) {
    message.service = Service::boot_up;
    message.text += "boot-up";
    for (Follower& follower : followers_) {
      if (follower.node_id == message.node_id) follower.sdo = {};  // the server has forgotten its transfer
    }
    NodeModel* const model = model_of(message.node_id);
    if (model != nullptr && model->reset()) find_routes();
    return;
  }
  message.text += canopen::to_text(found->state);
  // A node that produces heartbeats does not respond to guarding requests (CiA 301, 7.2.8.3.2).
  const NodeModel* const producer = model_of(message.node_id);
  const bool has_heartbeat = producer != nullptr && producer->parameter(0x1017, 0).value_or(0) != 0;
  if ((!was_asked || has_heartbeat) && !found->toggle) return;
  message.service = Service::guarding;
  message.text += found->toggle ? ", toggle 1" : ", toggle 0";
}

void Decoder::decode_pdo(const Frame& frame, std::span<const Route> routes, Message& message) {
  NodeModel& node = *model_of(routes.front().node_id);
  const PdoLayout& pdo = node.pdos()[routes.front().place];
  message.service = pdo.direction == PdoDirection::transmit ? Service::tpdo : Service::rpdo;
  message.node_id = node.node_id();
  message.number = pdo.number;
  message.pdo = &pdo;
  if (frame.remote) {
    message.text += "requested";
    return;
  }
  if (pdo.multiplexed) {
    if (frame.size != 8) return wrong_length(frame, "the 8 of a multiplex PDO", message);
    const MpdoAddress address = mpdo_address_of(frame);
    const bool is_own = address.destination && address.node_id == 0;
    return decode_mpdo(frame, address, is_own ? &node : model_of(address.node_id), message);
  }
  append_pdo(frame, pdo, node, message);
  for (const Route& route : routes.subspan(1)) {
    if (route.use != Use::pdo) continue;
    const PdoLayout& taken = model_of(route.node_id)->pdos()[route.place];
    const bool sender = taken.direction == PdoDirection::transmit;
    fmt::format_to(std::back_inserter(message.text), " -> {}PDO {} of node {}", sender ? 'T' : 'R', taken.number,
                   route.node_id);
    if (!sender) continue;
    message.problem = true;
    message.other_sender = route.node_id;
  }
}

void Decoder::decode_sdo(const TimedFrame& frame, std::size_t follower, bool request, Message& message) {
  Follower& channel = followers_[follower];
  message.service = Service::sdo;
  message.node_id = channel.node_id;
  message.from_client = request;
  message.channel = static_cast<std::uint16_t>(follower);
  if (frame.frame.remote || frame.frame.size != 8) {
    message.fault = SdoFault::length;
    return wrong_length(frame.frame, "8", message);
  }
  NodeModel* const model = model_of(channel.node_id);
  channel.sdo.follow(frame, request, model, message);
  if (model == nullptr || message.step != TransferStep::finished) return;
  if (model->learn(message.index, message.sub_index, channel.sdo.whole_value(), message.download)) find_routes();
}

std::vector<std::string> Decoder::open_transfers() const {
  std::vector<std::string> texts;
  for (const Follower& follower : followers_) {
    if (follower.sdo.open()) texts.push_back(fmt::format("node {}: {}", follower.node_id, follower.sdo.description()));
  }
  return texts;
}

}  // namespace edsc
