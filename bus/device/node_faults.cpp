#include "device/node_faults.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <canopen/base/abort_code.hpp>
#include <canopen/can/cob_id.hpp>
#include <iterator>
#include <utility>

#include "decode/sdo_initiate.hpp"
#include "text/printable.hpp"
#include "text/suggestion.hpp"

namespace edsc {
namespace {

namespace function_code = canopen::function_code;

// clang-format off
constexpr NodeFaultRow fault_table[] = {
    {NodeFaultKind::silent,       "silent",       "",                        "sends nothing; still executes what it receives"},
    {NodeFaultKind::no_boot_up,   "no-boot-up",   "",                        "does not send its boot-up message"},
    {NodeFaultKind::no_heartbeat, "no-heartbeat", "",                        "does not send heartbeats or responses to node guarding"},
    {NodeFaultKind::no_sdo,       "no-sdo",       "[OBJECT]",                "does not respond to SDO requests, of this object or of all"},
    {NodeFaultKind::sdo_delay,    "sdo-delay",    "TIME",                    "sends SDO responses later by this time"},
    {NodeFaultKind::sdo_drop,     "sdo-drop",     "1/N",                     "does not send every Nth SDO response"},
    {NodeFaultKind::sdo_toggle,   "sdo-toggle",   "",                        "sends segments with the wrong toggle bit"},
    {NodeFaultKind::abort,        "abort",        "OBJECT CODE [read|write]", "aborts SDO transfers of this object with this code"},
    {NodeFaultKind::pdo_short,    "pdo-short",    "N BYTES",                 "sends TPDO N with this number of bytes at most"},
    {NodeFaultKind::no_pdo,       "no-pdo",       "N",                       "does not send TPDO N"},
    {NodeFaultKind::babbling,     "babbling",     "",                        "sends EMCY FF00h each millisecond"},
    {NodeFaultKind::stuck,        "stuck",        "OBJECT",                  "the value does not change any more"},
    {NodeFaultKind::twin,         "twin",         "",                        "another node has the same node-ID: each frame is sent twice"},
    {NodeFaultKind::lost_node_id, "lost-node-id", "",                        "restarts without node-ID, as an unconfigured LSS slave"},
};
// clang-format on

constexpr std::uint64_t babbling_us = 1'000;

[[nodiscard]] bool has_id(const canopen::Frame& frame, std::uint32_t can_id) {
  return !frame.extended && !frame.remote && frame.id == can_id;
}

/// Whether the object of a fault, which may have none, is this entry.
bool names_entry(const NodeFault& fault, std::uint16_t index, std::uint8_t sub_index) {
  const CommandArguments& arguments = fault.arguments;
  if (arguments.object == nullptr) return true;
  return arguments.object->index == index && (arguments.entry == nullptr || arguments.entry->sub_index == sub_index);
}

bool aborts(const NodeFault& fault, const SdoInitiate& request) {
  const std::string& when = fault.arguments.word;
  return fault.row->kind == NodeFaultKind::abort && names_entry(fault, request.index, request.sub_index) &&
         (when.empty() || (when == "write") == request.is_download);
}

/// An SDO response to a segment.
bool is_segment_response(const canopen::Frame& frame) {
  const canopen::sdo::ServerCommand command = canopen::sdo::server_command(frame.data[0]);
  return command == canopen::sdo::ServerCommand::upload_segment ||
         command == canopen::sdo::ServerCommand::download_segment;
}

}  // namespace

std::span<const NodeFaultRow> node_fault_rows() { return fault_table; }

std::string read_fault(std::span<const std::string> words, EntryFinder& names, NodeFault& fault) {
  if (words.empty()) return "the name of a fault is missing";
  const auto* const row = std::ranges::find(fault_table, std::string_view{words[0]}, &NodeFaultRow::name);
  if (row == std::end(fault_table)) {
    std::vector<std::string_view> all;
    for (const NodeFaultRow& one : fault_table) all.push_back(one.name);
    return fmt::format("\"{}\" is not a fault{}", printable(words[0]), did_you_mean(words[0], all));
  }
  fault.row = row;
  words = words.subspan(1);
  if (words.size() >= 2 && words[words.size() - 2] == "for") {
    fault.span_us = command_time(words.back());
    if (!fault.span_us) return fmt::format("\"{}\" is not a duration", printable(words.back()));
    words = words.first(words.size() - 2);
  }
  const std::string problem = read_arguments(row->arguments, words, names, fault.arguments);
  if (problem.empty() && row->kind == NodeFaultKind::abort && fault.arguments.code == 0u)
    return "0 is not an abort code";
  return problem;
}

NodeFaults::NodeFaults(Node node) : node_{std::move(node)} {}

void NodeFaults::start(NodeFault fault, std::uint64_t now_us) {
  std::erase_if(active_, [&](const Active& active) {
    const CommandArguments &a = active.fault.arguments, &b = fault.arguments;
    return active.fault.row == fault.row && a.object == b.object && a.entry == b.entry && a.number == b.number;
  });
  Active active{std::move(fault), std::nullopt, now_us};
  if (active.fault.span_us) active.end_us = now_us + *active.fault.span_us;
  if (active.fault.row->kind == NodeFaultKind::twin) {
    canopen::Frame boot_up{};
    boot_up.id = function_code::error_control + node_.node_id();
    boot_up.size = 1;
    queue(boot_up, now_us);
  }
  active_.push_back(std::move(active));
}

void NodeFaults::clear() { active_.clear(); }

void NodeFaults::on_time(std::uint64_t now_us) {
  std::erase_if(active_, [&](const Active& active) { return active.end_us && *active.end_us <= now_us; });
  for (Active& active : active_) {
    if (active.fault.row->kind != NodeFaultKind::babbling || active.next_us > now_us) continue;
    canopen::Frame frame{};
    frame.id = function_code::emcy + node_.node_id();
    frame.size = 8;
    frame.data = {0x00, 0xFF, 0x01};
    queue(frame, now_us);
    active.next_us = now_us + babbling_us;
  }
}

std::optional<std::uint64_t> NodeFaults::next_us() const {
  std::optional<std::uint64_t> next;
  const auto consider = [&next](std::uint64_t time) { next = next ? std::min(*next, time) : time; };
  for (const Active& active : active_) {
    if (active.end_us) consider(*active.end_us);
    if (active.fault.row->kind == NodeFaultKind::babbling) consider(active.next_us);
  }
  if (!queue_.empty()) consider(queue_.front().due_us);
  return next;
}

bool NodeFaults::has(NodeFaultKind kind) const {
  return std::ranges::any_of(active_, [kind](const Active& active) { return active.fault.row->kind == kind; });
}

bool NodeFaults::has(NodeFaultKind kind, std::uint16_t index, std::uint8_t sub_index) const {
  return std::ranges::any_of(active_, [&](const Active& active) {
    return active.fault.row->kind == kind && names_entry(active.fault, index, sub_index);
  });
}

std::string NodeFaults::text() const {
  std::string text;
  for (const Active& active : active_) text.append(text.empty() ? "" : ", ").append(active.fault.row->name);
  return text;
}

bool NodeFaults::receive(const canopen::Frame& frame, std::uint64_t now_us) {
  if (!has_id(frame, function_code::sdo_request + node_.node_id())) return true;
  const std::optional<SdoInitiate> request = sdo_initiate(frame);
  for (const Active& active : active_) {
    const NodeFault& fault = active.fault;
    if (fault.row->kind == NodeFaultKind::no_sdo) {
      if (fault.arguments.object == nullptr) return false;
      if (request && names_entry(fault, request->index, request->sub_index)) return false;
    }
    if (!request || !aborts(fault, *request)) continue;
    canopen::Frame response{};
    response.id = function_code::sdo_response + node_.node_id();
    response.size = 8;
    response.data[0] = canopen::sdo::abort_command;
    canopen::sdo::put_multiplexer(response.data, request->index, request->sub_index);
    canopen::sdo::put_word(response.data, *fault.arguments.code);
    send(response, now_us);
    return false;
  }
  return true;
}

bool NodeFaults::is_tpdo(const Active& active, const canopen::Frame& frame) const {
  const std::optional<std::uint32_t> cob_id = node_.cob_id_of_tpdo(*active.fault.arguments.number);
  return cob_id && canopen::can_id_of(*cob_id, frame.extended) == frame.id && !frame.remote;
}

bool NodeFaults::change(Active& active, canopen::Frame& frame, std::uint64_t& due_us) const {
  const CommandArguments& arguments = active.fault.arguments;
  const bool is_response = has_id(frame, function_code::sdo_response + node_.node_id());
  const bool is_error_control = has_id(frame, function_code::error_control + node_.node_id());
  switch (active.fault.row->kind) {
    case NodeFaultKind::silent: return false;
    case NodeFaultKind::no_boot_up: return !is_error_control || frame.data[0] != 0;
    case NodeFaultKind::no_heartbeat: return !is_error_control || frame.data[0] == 0;
    case NodeFaultKind::sdo_delay:
      if (is_response) due_us += *arguments.time_us;
      return true;
    case NodeFaultKind::sdo_drop: return !is_response || ++active.frames % *arguments.number != 0;
    case NodeFaultKind::sdo_toggle:
      if (is_response && is_segment_response(frame)) frame.data[0] ^= canopen::sdo::toggle;
      return true;
    case NodeFaultKind::pdo_short:
      if (is_tpdo(active, frame))
        frame.size = static_cast<std::uint8_t>(std::min<unsigned>(frame.size, *arguments.count));
      return true;
    case NodeFaultKind::no_pdo: return !is_tpdo(active, frame);
    case NodeFaultKind::no_sdo:
    case NodeFaultKind::abort:
    case NodeFaultKind::babbling:
    case NodeFaultKind::stuck:
    case NodeFaultKind::twin:
    case NodeFaultKind::lost_node_id: return true;
  }
  return true;
}

void NodeFaults::send(const canopen::Frame& frame, std::uint64_t now_us) {
  canopen::Frame changed = frame;
  std::uint64_t due_us = now_us;
  for (Active& active : active_) {
    if (!change(active, changed, due_us)) return;
  }
  queue(changed, due_us);
  if (has(NodeFaultKind::twin)) queue(changed, due_us);
}

void NodeFaults::queue(const canopen::Frame& frame, std::uint64_t due_us) {
  const auto at = std::ranges::upper_bound(queue_, due_us, {}, &Queued::due_us);
  queue_.insert(at, {frame, due_us});
}

const canopen::Frame* NodeFaults::first_due(std::uint64_t now_us) const {
  return !queue_.empty() && queue_.front().due_us <= now_us ? &queue_.front().frame : nullptr;
}

void NodeFaults::sent() { queue_.erase(queue_.begin()); }

}  // namespace edsc
