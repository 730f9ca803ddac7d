#include "decode/decoder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <canopen/can/cob_id.hpp>
#include <canopen/lss/lss_protocol.hpp>
#include <canopen/nmt/nmt.hpp>
#include <iterator>

#include "decode/emergency_text.hpp"
#include "decode/error_frame_text.hpp"
#include "decode/lss_text.hpp"
#include "text/counted.hpp"
#include "values/append.hpp"
#include "values/value_text.hpp"

namespace edsc {
namespace {

namespace function_code = canopen::function_code;

using canopen::CobId;
using canopen::Frame;

constexpr std::uint32_t function_mask = 0x780, node_mask = 0x7F;
constexpr std::size_t max_further_followers = 1024;

struct CommandRow {
  canopen::NmtCommand command;
  std::string_view text;
};

constexpr CommandRow commands[] = {
    {canopen::NmtCommand::start, "start"},
    {canopen::NmtCommand::stop, "stop"},
    {canopen::NmtCommand::enter_pre_operational, "enter pre-operational"},
    {canopen::NmtCommand::reset_node, "reset node"},
    {canopen::NmtCommand::reset_communication, "reset communication"},
};

struct StateRow {
  canopen::NmtState state;
  std::string_view text;
};

constexpr StateRow states[] = {
    {canopen::NmtState::initialisation, "initialisation"},
    {canopen::NmtState::stopped, "stopped"},
    {canopen::NmtState::operational, "operational"},
    {canopen::NmtState::pre_operational, "pre-operational"},
};

std::string_view state_text(std::uint8_t code) {
  for (const StateRow& row : states) {
    if (static_cast<std::uint8_t>(row.state) == code) return row.text;
  }
  return {};
}

void append_can_id(std::string& text, const Frame& frame) {
  append_hex(text, frame.id, frame.extended ? 8 : 3);
  text += 'h';
}

void append_bytes(std::string& text, const Frame& frame, std::size_t first) {
  for (std::size_t i = first; i < frame.size; ++i) {
    text += ' ';
    append_hex_byte(text, frame.data[i]);
  }
}

void wrong_length(const Frame& frame, std::string_view right, Message& message) {
  message.problem = true;
  if (frame.remote) {
    message.text += "a remote frame, not a frame with data";
    return;
  }
  fmt::format_to(std::back_inserter(message.text), "{}, not {}", counted(unsigned{frame.size}, "byte"), right);
}

std::uint64_t word_of(const Frame& frame) {
  std::uint64_t word = 0;
  for (std::size_t i = 8; i-- > 0;) word = word << 8 | (i < frame.size ? frame.data[i] : 0);
  return word;
}

void append_field(std::string& text, const PdoField& field, std::uint64_t word, Message& message) {
  const std::uint64_t number = field.offset < 64 ? word >> field.offset : 0;
  MessageValue value;
  value.index = field.index;
  value.sub_index = field.sub_index;
  value.name = field.name;
  value.type = field.type;
  value.number = field.bits >= 64 ? number : number & ((std::uint64_t{1} << field.bits) - 1);
  value.bits = field.bits;
  text += field.name;
  text += " = ";
  value.text_begin = text.size();
  if (field.drive_word != DriveWord::none) {
    append_drive_word(text, field.drive_word, static_cast<std::uint16_t>(value.number));
  } else if (field.type == nullptr) {
    append_hex(text, value.number, (field.bits + 3U) / 4U);
    text += 'h';
  } else if (field.type->kind == canopen::DataClass::string) {
    std::array<std::uint8_t, 8> bytes{};
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(value.number >> (8 * i));
    append_value(text, *field.type, std::span{bytes}.first((field.bits + 7U) / 8U));
  } else {
    if (field.entry != nullptr) value.unit = field.entry->unit;
    append_number(text, *field.type, value.number, field.bits, value.unit);
  }
  value.text_end = text.size();
  message.values.push_back(value);
}

/// CAN-IDs with a fixed meaning: NMT, default SDO, error control, LSS.
bool belongs_to_all_nodes(std::uint32_t can_id) {
  if (can_id == function_code::nmt || can_id == canopen::lss::request_id || can_id == canopen::lss::response_id)
    return true;
  if ((can_id & node_mask) == 0) return false;
  const std::uint32_t function = can_id & function_mask;
  return function == function_code::sdo_request || function == function_code::sdo_response ||
         function == function_code::error_control;
}

/// `TPDO 2 of node 7`; nothing for CAN-IDs of other services.
std::string predefined_pdo(std::uint32_t can_id) {
  if (can_id < function_code::tpdo1 || can_id >= function_code::sdo_response || (can_id & node_mask) == 0) return "";
  const std::uint32_t base = can_id & function_mask;
  const bool transmit = (base & 0x80) != 0;
  return fmt::format("{}PDO {} of node {}", transmit ? 'T' : 'R', transmit ? base / 0x100 : base / 0x100 - 1,
                     can_id & node_mask);
}

}  // namespace

Decoder::Decoder(const std::vector<KnownNode>& nodes) {
  for (const KnownNode& node : nodes) {
    std::uint8_t& place = place_of_node_[node.node_id & node_mask];
    if (place != 0) {
      nodes_[place - 1U] = NodeModel{node.node_id, *node.device};
      continue;
    }
    nodes_.emplace_back(node.node_id, *node.device);
    place = static_cast<std::uint8_t>(nodes_.size());
  }
  followers_.resize(node_ids);
  for (std::size_t id = 0; id < node_ids; ++id) followers_[id].node_id = static_cast<std::uint8_t>(id);
  find_routes();
}

NodeModel* Decoder::model_of(std::uint8_t node_id) {
  const std::uint8_t place = place_of_node_[node_id & node_mask];
  return place == 0 ? nullptr : &nodes_[place - 1U];
}

// Use of CAN-IDs

void Decoder::add_route(CobId cob_id, Route route) {
  if (!cob_id.valid() || (!cob_id.extended() && belongs_to_all_nodes(cob_id.can_id()))) return;
  (cob_id.extended() ? extended_routes_[cob_id.can_id()] : routes_[cob_id.can_id()]).push_back(route);
}

void Decoder::find_routes() {
  for (auto& routes : routes_) routes.clear();
  extended_routes_.clear();
  // The sender comes first: the TPDO of one node is the RPDO of another.
  for (const PdoDirection direction : {PdoDirection::transmit, PdoDirection::receive}) {
    for (std::size_t node = 0; node < nodes_.size(); ++node) {
      const auto& pdos = nodes_[node].pdos();
      for (std::size_t at = 0; at < pdos.size(); ++at) {
        if (pdos[at].direction != direction) continue;
        add_route(pdos[at].cob_id, {Use::pdo, static_cast<std::uint8_t>(node), static_cast<std::uint16_t>(at)});
      }
    }
  }
  for (std::size_t node = 0; node < nodes_.size(); ++node) {
    const NodeModel& model = nodes_[node];
    const auto place = static_cast<std::uint8_t>(node);
    if (const auto id = model.sync()) add_route(*id, {Use::sync, place, 0});
    if (const auto id = model.time()) add_route(*id, {Use::time, place, 0});
    if (const auto id = model.emcy()) add_route(*id, {Use::emcy, place, 0});
    for (const SdoServerIds& ids : model.further_sdo_servers()) {
      const std::uint64_t key = std::uint64_t{ids.request.value() & 0x3FFF'FFFF} << 32 | ids.response.value();
      auto at = further_followers_.find(key * 131 + model.node_id());
      if (at == further_followers_.end()) {
        if (further_followers_.size() >= max_further_followers) continue;
        at = further_followers_.emplace(key * 131 + model.node_id(), followers_.size()).first;
        followers_.push_back({model.node_id(), {}});
      }
      const auto follower = static_cast<std::uint16_t>(at->second);
      add_route(ids.request, {Use::sdo_request, place, follower});
      add_route(ids.response, {Use::sdo_response, place, follower});
    }
  }
}

const std::vector<Decoder::Route>* Decoder::routes_of(const Frame& frame) const {
  if (!frame.extended) return &routes_[frame.id & (can_ids - 1)];
  const auto at = extended_routes_.find(frame.id);
  return at == extended_routes_.end() ? nullptr : &at->second;
}

// Frames

void Decoder::decode(const TimedFrame& frame, Message& message) {
  message.clear();
  const auto* routes = routes_of(frame.frame);
  if (routes != nullptr && !routes->empty()) return decode_routed(frame, *routes, message);
  if (frame.frame.extended) return decode_unknown(frame.frame, message);
  decode_predefined(frame, message);
}

void Decoder::decode_error_frame(const Frame& frame, Message& message) {
  message.clear();
  message.service = Service::error_frame;
  message.problem = true;
  append_error_frame_text(message.text, frame);
}

void Decoder::decode_routed(const TimedFrame& frame, const std::vector<Route>& routes, Message& message) {
  const Route route = routes.front();
  switch (route.use) {
    case Use::none: return;
    case Use::pdo: return decode_pdo(frame.frame, routes, message);
    case Use::sync: return decode_sync(frame.frame, message);
    case Use::time: return decode_time(frame.frame, message);
    case Use::emcy: return decode_emcy(frame.frame, nodes_[route.node].node_id(), message);
    case Use::sdo_request: return decode_sdo(frame, route.place, true, message);
    case Use::sdo_response: return decode_sdo(frame, route.place, false, message);
  }
}

void Decoder::decode_predefined(const TimedFrame& frame, Message& message) {
  const std::uint32_t id = frame.frame.id;
  const auto node_id = static_cast<std::uint8_t>(id & node_mask);
  if (id == canopen::lss::request_id || id == canopen::lss::response_id) return decode_lss(frame.frame, message);
  switch (id & function_mask) {
    case function_code::nmt:
      if (node_id == 0) return decode_nmt(frame.frame, message);
      break;
    case function_code::sync:
      return node_id == 0 ? decode_sync(frame.frame, message) : decode_emcy(frame.frame, node_id, message);
    case function_code::time:
      if (node_id == 0) return decode_time(frame.frame, message);
      break;
    case function_code::sdo_response:
      if (node_id != 0) return decode_sdo(frame, node_id, false, message);
      break;
    case function_code::sdo_request:
      if (node_id != 0) return decode_sdo(frame, node_id, true, message);
      break;
    case function_code::error_control:
      if (node_id != 0) return decode_error_control(frame.frame, message);
      break;
    default: break;
  }
  decode_unknown(frame.frame, message);
}

void Decoder::decode_unknown(const Frame& frame, Message& message) const {
  message.service = Service::unknown;
  message.problem = true;
  message.text += "CAN-ID ";
  append_can_id(message.text, frame);
  message.text += " is not used by any known node";
  if (frame.extended) return;
  if (const std::string pdo = predefined_pdo(frame.id); !pdo.empty()) {
    message.text += "; in the pre-defined connection set it is " + pdo;
  } else if (const char* reason = canopen::restriction_of(frame.id)) {
    message.text += std::string{"; restricted by CiA 301: "} + reason;
  }
}

// Services

void Decoder::decode_nmt(const Frame& frame, Message& message) {
  message.service = Service::nmt;
  if (frame.remote || frame.size < 2) return wrong_length(frame, "the 2 of a command", message);
  message.node_id = frame.data[1];
  for (const CommandRow& row : commands) {
    if (static_cast<std::uint8_t>(row.command) == frame.data[0]) message.command = row.text;
  }
  if (message.command.empty()) {
    fmt::format_to(std::back_inserter(message.text), "unknown command {}", frame.data[0]);
    message.problem = true;
  } else {
    message.text += message.command;
  }
  if (message.node_id == 0) message.text += ", all nodes";
}

void Decoder::decode_sync(const Frame& frame, Message& message) {
  message.service = Service::sync;
  if (frame.remote || frame.size > 1) return wrong_length(frame, "0 or 1", message);
  if (frame.size == 0) return;
  message.counter = frame.data[0];
  message.text += "counter ";
  append_decimal(message.text, frame.data[0]);
}

void Decoder::decode_time(const Frame& frame, Message& message) {
  message.service = Service::time;
  if (frame.remote || frame.size < 6) return wrong_length(frame, "6", message);
  constexpr unsigned bits = 48;
  append_number(message.text, *canopen::find_data_type(static_cast<std::uint32_t>(canopen::DataType::time_of_day)),
                word_of(frame), bits);
}

void Decoder::decode_emcy(const Frame& frame, std::uint8_t node_id, Message& message) {
  message.service = Service::emcy;
  message.node_id = node_id;
  if (frame.remote || frame.size < 3) return wrong_length(frame, "8", message);
  message.error_code = static_cast<std::uint16_t>(frame.data[0] | frame.data[1] << 8);
  message.error_register = frame.data[2];
  const NodeModel* model = model_of(node_id);
  const bool gone = message.error_code <= 0x00FF;
  message.problem = !gone;
  append_hex(message.text, message.error_code, 4);
  message.text += "h ";
  message.text += emergency_text(message.error_code, model != nullptr ? model->profile() : std::uint16_t{0});
  message.text += ", error register ";
  append_hex_byte(message.text, message.error_register);
  message.text += "h (";
  append_error_register(message.text, message.error_register);
  message.text += ')';
  const bool manufacturer =
      std::any_of(frame.data.begin() + 3, frame.data.begin() + frame.size, [](auto b) { return b != 0; });
  if (manufacturer) {
    message.text += ", manufacturer";
    append_bytes(message.text, frame, 3);
  }
}

void Decoder::decode_error_control(const Frame& frame, Message& message) {
  const auto node_id = static_cast<std::uint8_t>(frame.id & node_mask);
  message.node_id = node_id;
  message.service = Service::heartbeat;
  if (frame.remote) {
    message.service = Service::guarding;
    message.text += "state requested";
    guarding_asked_[node_id] = true;
    return;
  }
  if (frame.size != 1) return wrong_length(frame, "1", message);
  const bool toggle = (frame.data[0] & 0x80) != 0;
  const auto code = static_cast<std::uint8_t>(frame.data[0] & 0x7F);
  const bool answer = guarding_asked_[node_id] || toggle;
  guarding_asked_[node_id] = false;
  message.state = state_text(code);
  if (message.state.empty()) {
    fmt::format_to(std::back_inserter(message.text), "unknown state {}", code);
    message.problem = true;
    return;
  }
  if (code == 0 && !toggle) {
    message.service = Service::boot_up;
    message.text += "boot-up";
    NodeModel* model = model_of(node_id);
    if (model != nullptr && model->reset()) find_routes();
    return;
  }
  message.text += message.state;
  if (!answer) return;
  message.service = Service::guarding;
  message.text += toggle ? ", toggle 1" : ", toggle 0";
}

void Decoder::decode_lss(const Frame& frame, Message& message) {
  message.service = Service::lss;
  message.from_client = frame.id == canopen::lss::request_id;
  message.problem = !append_lss_text(message.text, frame, message.from_client);
}

// PDOs

void Decoder::decode_pdo(const Frame& frame, const std::vector<Route>& routes, Message& message) {
  const Route route = routes.front();
  const NodeModel& node = nodes_[route.node];
  const PdoLayout& pdo = node.pdos()[route.place];
  message.service = pdo.direction == PdoDirection::transmit ? Service::tpdo : Service::rpdo;
  message.node_id = node.node_id();
  message.number = pdo.number;
  if (frame.remote) {
    message.text += "requested";
    return;
  }
  if (pdo.multiplexed) return decode_mpdo(frame, node, message);
  const std::uint64_t word = word_of(frame);
  const unsigned bits = frame.size * 8U;
  const char* separator = "";
  for (const PdoField& field : pdo.fields) {
    if (static_cast<unsigned>(field.offset) + field.bits > bits) break;
    message.text += separator;
    append_field(message.text, field, word, message);
    separator = ", ";
  }
  if (pdo.fields.empty()) {
    message.text += "no object is mapped";
    message.problem = frame.size > 0;
  } else if (bits < pdo.bits) {
    fmt::format_to(std::back_inserter(message.text), "{}too short: {} of {}", separator, frame.size,
                   counted((pdo.bits + 7) / 8, "byte"));
    message.problem = true;
  } else if (frame.size > (pdo.bits + 7) / 8) {
    fmt::format_to(std::back_inserter(message.text), "{}{} more than mapped", separator,
                   counted(frame.size - (pdo.bits + 7) / 8, "byte"));
  }
  for (std::size_t i = 1; i < routes.size(); ++i) {
    if (routes[i].use != Use::pdo) continue;
    const NodeModel& other = nodes_[routes[i].node];
    const PdoLayout& taken = other.pdos()[routes[i].place];
    const bool sender = taken.direction == PdoDirection::transmit;
    fmt::format_to(std::back_inserter(message.text), " -> {}PDO {} of node {}", sender ? 'T' : 'R', taken.number,
                   other.node_id());
    if (sender) message.problem = true;
  }
}

/// A multiplex PDO contains the address of its object (CiA 301, 7.2.2.5).
void Decoder::decode_mpdo(const Frame& frame, const NodeModel& node, Message& message) {
  if (frame.size != 8) return wrong_length(frame, "the 8 of a multiplex PDO", message);
  const bool destination = (frame.data[0] & 0x80) != 0;
  const auto node_id = static_cast<std::uint8_t>(frame.data[0] & node_mask);
  const NodeModel* owner = model_of(node_id);
  if (destination && node_id == 0) owner = &node;
  PdoField field;
  field.index = static_cast<std::uint16_t>(frame.data[1] | frame.data[2] << 8);
  field.sub_index = frame.data[3];
  field.offset = 32;
  field.bits = 32;
  const Object* object = owner != nullptr ? owner->device().find(field.index) : nullptr;
  field.entry = object != nullptr ? object->find(field.sub_index) : nullptr;
  if (field.entry != nullptr) {
    field.type = field.entry->type;
    if (field.type->bits > 0 && field.type->bits < 32) field.bits = field.type->bits;
    field.name = display_name(*object, *field.entry);
  }
  message.text += destination ? "to " : "from ";
  if (node_id == 0) {
    message.text += "all nodes, ";
  } else {
    fmt::format_to(std::back_inserter(message.text), "node {}, ", node_id);
  }
  field.name = field.name.empty() ? entry_label(field.index, field.sub_index)
                                  : entry_label(field.index, field.sub_index) + " " + field.name;
  append_field(message.text, field, word_of(frame), message);
  message.values.back().name = field.entry != nullptr ? std::string_view{field.entry->name} : std::string_view{};
}

// SDOs

void Decoder::decode_sdo(const TimedFrame& frame, std::size_t follower, bool request, Message& message) {
  Follower& channel = followers_[follower];
  message.service = Service::sdo;
  message.node_id = channel.node_id;
  message.from_client = request;
  if (frame.frame.remote || frame.frame.size != 8) return wrong_length(frame.frame, "8", message);
  NodeModel* model = model_of(channel.node_id);
  if (request) {
    channel.sdo.request(frame, model, message);
  } else {
    channel.sdo.response(frame, model, message);
  }
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
