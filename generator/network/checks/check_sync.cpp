#include <fmt/format.h>

#include <algorithm>
#include <canopen/can/cob_id.hpp>
#include <string>
#include <utility>

#include "device/pdo/pdo_defaults.hpp"
#include "network/checks/check_groups.hpp"
#include "network/communication_objects.hpp"
#include "network/configured_pdo.hpp"

namespace edsc {
namespace {

bool is_synchronous_pdo(const CobIdUse& use) {
  if (use.service != FrameService::pdo) return false;
  const auto type = communication_default(*use.pdo, transmission_type_sub_index);
  return type && communication::is_synchronous(*type);
}

std::vector<const CobIdUse*> uses_of(const NetworkContext& context, FrameService service, bool transmits) {
  std::vector<const CobIdUse*> found;
  for (const CobIdUse& use : context.uses) {
    if (use.service == service && use.transmits == transmits) found.push_back(&use);
  }
  return found;
}

/// Whether the network uses a PDO: it states a parameter of it, or another node sends or receives it.
bool is_used(const NetworkContext& context, const CobIdUse& use) {
  return !is_as_in_eds(*use.node, *use.pdo) || std::ranges::any_of(context.uses, [&](const CobIdUse& other) {
    return other.service == FrameService::pdo && other.transmits != use.transmits && other.node != use.node &&
           other.can_id == use.can_id && other.extended == use.extended;
  });
}

/// `, or disable it by "set": {"1802h:01": "0xC0000384"}`; empty if its COB-ID cannot be written.
std::string disabling_text(const CobIdUse& use) {
  const std::uint16_t index = use.pdo->communication->index;
  const Entry* const entry = use.node->device().find(index, 1);
  if (entry == nullptr || !entry->default_value || !canopen::writable(entry->access)) return {};
  return fmt::format(", or disable the PDO by \"set\": {{\"{}\": \"0x{:X}\"}}", entry_label(index, 1),
                     entry->default_value->bits | canopen::CobId::invalid_bit);
}

/// Without a producer, the first synchronous PDO that the network uses is named. One that it does not use is as in the
/// EDS: it is not sent or applied, and nothing else depends on it.
void report_missing_producer(const NetworkContext& context) {
  const auto used = std::ranges::find_if(
      context.uses, [&](const CobIdUse& use) { return is_synchronous_pdo(use) && is_used(context, use); });
  const bool is_any_used = used != context.uses.end();
  const auto first = is_any_used ? used : std::ranges::find_if(context.uses, is_synchronous_pdo);
  if (first == context.uses.end()) return;
  const auto count = std::ranges::count_if(context.uses, is_synchronous_pdo);
  const std::string message =
      fmt::format("{} is synchronous, but no node produces SYNC{}; state a \"producer\" in \"sync\"{}", named(*first),
                  count > 1 ? fmt::format(" ({} synchronous PDOs)", count) : "", disabling_text(*first));
  if (is_any_used) {
    context.diagnostics.error("network-sync", first->position, message);
  } else {
    context.diagnostics.warning("network-sync", first->position, message);
  }
}

void check_producers(const NetworkContext& context, const std::vector<const CobIdUse*>& producers) {
  for (std::size_t i = 1; i < producers.size(); ++i) {
    context.diagnostics.error(
        "network-sync", producers[i]->position,
        fmt::format("nodes {} and {} produce SYNC", producers[0]->node->name, producers[i]->node->name),
        {{producers[0]->position, producers[0]->node->name}});
  }
  const NetworkNode& node = *producers.front()->node;
  if (value_of(node.device(), communication::cycle_period).value_or(0) == 0) {
    context.diagnostics.warning(
        "network-sync", place_of_value(node.device(), communication::cycle_period),
        fmt::format("node {} produces SYNC, but its communication cycle period (1006h) is 0", node.name));
  }
}

/// A node with synchronous PDOs must consume the CAN-ID and the counter that the producer sends.
void check_consumer(const NetworkContext& context, const CobIdUse& producer, const CobIdUse& consumer) {
  const bool has_synchronous_pdos = std::ranges::any_of(
      context.uses, [&](const CobIdUse& use) { return use.node == consumer.node && is_synchronous_pdo(use); });
  if (!has_synchronous_pdos) return;
  if (consumer.can_id != producer.can_id || consumer.extended != producer.extended) {
    context.diagnostics.error("network-sync", consumer.position,
                              fmt::format("node {} consumes SYNC with CAN-ID {}, node {} produces it with {}",
                                          consumer.node->name, can_id_text(consumer.can_id, consumer.extended),
                                          producer.node->name, can_id_text(producer.can_id, producer.extended)),
                              {{producer.position, producer.node->name}});
  }
  const std::uint64_t sent = value_of(producer.node->device(), communication::sync_overflow).value_or(0);
  const std::uint64_t expected = value_of(consumer.node->device(), communication::sync_overflow).value_or(0);
  if (sent != expected) {
    context.diagnostics.error(
        "network-sync-counter", place_of_value(consumer.node->device(), communication::sync_overflow),
        fmt::format("node {} expects a SYNC counter overflow value (1019h) of {}, node {} has {}", consumer.node->name,
                    expected, producer.node->name, sent),
        {{place_of_value(producer.node->device(), communication::sync_overflow), producer.node->name}});
  }
}

/// A window that is not shorter than the period has no effect (CiA 301, 7.5.2.7). That of `sync` is the window of all
/// nodes: it is reported once.
void check_windows(const NetworkContext& context, const NetworkNode& producer) {
  const std::uint64_t period = value_of(producer.device(), communication::cycle_period).value_or(0);
  const WrittenNumber& of_network = context.network.description.sync.window_us;
  bool is_reported = false;
  for (const NetworkNode& node : context.network.nodes) {
    const std::uint64_t window = value_of(node.device(), communication::window_length).value_or(0);
    if (period == 0 || window <= period) continue;
    const Position place = place_of_value(node.device(), communication::window_length);
    const bool is_of_network = of_network && place.file == of_network->position.file &&
                               place.line == of_network->position.line && place.column == of_network->position.column;
    if (is_of_network && std::exchange(is_reported, true)) continue;
    context.diagnostics.error(
        "network-sync-window", place,
        fmt::format("{} a synchronous window (1007h) of {} us, longer than the period of {} us",
                    is_of_network ? "all nodes have" : fmt::format("node {} has", node.name), window, period));
  }
}

void check_time(const NetworkContext& context) {
  const auto producers = uses_of(context, FrameService::time, true);
  const auto consumers = uses_of(context, FrameService::time, false);
  for (std::size_t i = 1; i < producers.size(); ++i) {
    context.diagnostics.warning(
        "network-time", producers[i]->position,
        fmt::format("nodes {} and {} produce TIME", producers[0]->node->name, producers[i]->node->name),
        {{producers[0]->position, producers[0]->node->name}});
  }
  if (consumers.empty()) return;
  if (producers.empty()) {
    context.diagnostics.warning(
        "network-time", consumers.front()->position,
        fmt::format("node {} consumes TIME, which no node produces", consumers.front()->node->name));
    return;
  }
  const CobIdUse& producer = *producers.front();
  for (const CobIdUse* const consumer : consumers) {
    if (consumer->can_id == producer.can_id && consumer->extended == producer.extended) continue;
    context.diagnostics.warning("network-time", consumer->position,
                                fmt::format("node {} consumes TIME with CAN-ID {}, node {} produces it with {}",
                                            consumer->node->name, can_id_text(consumer->can_id, consumer->extended),
                                            producer.node->name, can_id_text(producer.can_id, producer.extended)),
                                {{producer.position, producer.node->name}});
  }
}

}  // namespace

void check_sync(const NetworkContext& context) {
  const auto producers = uses_of(context, FrameService::sync, true);
  if (producers.empty()) {
    report_missing_producer(context);
  } else {
    check_producers(context, producers);
    for (const CobIdUse* const consumer : uses_of(context, FrameService::sync, false)) {
      check_consumer(context, *producers.front(), *consumer);
    }
    check_windows(context, *producers.front()->node);
  }
  check_time(context);
}

}  // namespace edsc
