#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "network/checks/check_groups.hpp"
#include "network/checks/merged_note.hpp"
#include "network/communication_objects.hpp"
#include "network/error_control.hpp"

namespace edsc {
namespace {

/// The NMT masters: nodes of the network file with `master`.
void check_master(const NetworkContext& context) {
  std::vector<const NetworkNode*> masters;
  for (const NetworkNode& node : context.network.nodes) {
    if (node.is_master) masters.push_back(&node);
  }
  for (std::size_t i = 1; i < masters.size(); ++i) {
    context.diagnostics.warning("network-nmt-master", masters[i]->position,
                                fmt::format("nodes {} and {} are NMT masters", masters[0]->name, masters[i]->name),
                                {{masters[0]->position, masters[0]->name}});
  }
  if (masters.empty()) {
    context.diagnostics.warning("network-nmt-master", Position{context.network.source.get()},
                                "no node is the NMT master: \"master\": true");
  }
}

class HeartbeatCheck {
 public:
  explicit HeartbeatCheck(const NetworkContext& context) : context_{context} {}

  void check() {
    for (const NetworkNode& node : context_.network.nodes) check_consumer(node);
    for (const NetworkNode& node : context_.network.nodes) {
      check_guarding(node);
      check_monitoring(node);
    }
    check_monitoring_of_master();
  }

 private:
  void check_consumer(const NetworkNode& consumer) {
    const Object* const object = consumer.device().find(communication::consumer_heartbeat);
    if (object == nullptr) return;
    for (const Entry& entry : object->entries) {
      if (entry.sub_index == 0 || !entry.default_value) continue;
      const auto value = static_cast<std::uint32_t>(entry.default_value->bits);
      const unsigned node_id = value >> 16 & 0xFF;
      const unsigned time = value & 0xFFFF;
      if (node_id != 0 && time != 0) check_pair(consumer, entry, node_id, time);
    }
  }

  void check_pair(const NetworkNode& consumer, const Entry& entry, unsigned node_id, unsigned time) {
    const auto error = [&](std::string_view why) {
      context_.diagnostics.error(
          "network-heartbeat", default_place(entry),
          fmt::format("node {} monitors the heartbeat of node-ID {} in {} ms, {}", consumer.name, node_id, time, why));
    };
    const auto producer = std::ranges::find(context_.network.nodes, node_id, &NetworkNode::node_id);
    if (producer == context_.network.nodes.end()) {  // monitoring starts with the first heartbeat: it has no effect
      context_.diagnostics.warning(
          "network-heartbeat", default_place(entry),
          fmt::format("node {} monitors the heartbeat of node-ID {}, which is not in the network", consumer.name,
                      node_id));
      return;
    }
    consumers_.insert(&consumer);
    if (&*producer == &consumer) return error("which is itself");
    monitored_.insert(&*producer);
    const std::uint64_t produced = heartbeat_time(producer->device());
    if (produced == 0) return error(fmt::format("but {} does not produce a heartbeat (1017h is 0)", producer->name));
    if (time <= produced) error(fmt::format("but {} produces it every {} ms (1017h)", producer->name, produced));
  }

  void check_guarding(const NetworkNode& node) {
    if (!node_guarding(node.device())) return;
    if (heartbeat_time(node.device()) != 0) {
      context_.diagnostics.warning(
          "network-guarding", place_of_value(node.device(), communication::guard_time),
          fmt::format("node {} has guarding (100Ch, 100Dh) and a heartbeat (1017h); the "
                      "heartbeat is used",
                      node.name),
          {{place_of_value(node.device(), communication::producer_heartbeat), "the heartbeat"}});
      return;
    }
    if (context_.network.master() == nullptr) {
      context_.diagnostics.warning(
          "network-guarding", place_of_value(node.device(), communication::guard_time),
          fmt::format("node {} expects guarding, but the network has no NMT master", node.name));
    }
  }

  void check_monitoring(const NetworkNode& node) {
    if (node.is_master || monitored_.contains(&node)) return;
    const bool is_guarded_by_master = node_guarding(node.device()) && heartbeat_time(node.device()) == 0;
    if (is_guarded_by_master && context_.network.master() != nullptr) return;
    context_.diagnostics.warning("network-unmonitored", node.position,
                                 heartbeat_time(node.device()) == 0
                                     ? fmt::format("node {} has neither heartbeat nor guarding", node.name)
                                     : fmt::format("no node monitors the heartbeat of node {}", node.name),
                                 {}, "error control");
  }

  /// A node without a consumer does not notice that the master is lost: a drive keeps its last set-point. One note for
  /// all nodes that could monitor it.
  void check_monitoring_of_master() {
    const NetworkNode* const master = context_.network.master();
    if (master == nullptr || heartbeat_time(master->device()) == 0) return;
    MergedNote note;
    for (const NetworkNode& node : context_.network.nodes) {
      if (node.is_master || consumers_.contains(&node)) continue;
      if (node.device().find(communication::consumer_heartbeat) == nullptr) continue;
      note.add("network-unmonitored", node.position,
               fmt::format("node {} has 1016h, but does not monitor the heartbeat of a node; \"master_timeout_ms\" is "
                           "its time for the master {}",
                           node.name, master->name));
    }
    note.report(context_.diagnostics);
  }

  const NetworkContext& context_;
  std::set<const NetworkNode*> monitored_;
  std::set<const NetworkNode*> consumers_;  ///< with an entry of 1016h that is in use
};

}  // namespace

void check_error_control(const NetworkContext& context) {
  check_master(context);
  HeartbeatCheck{context}.check();
}

}  // namespace edsc
