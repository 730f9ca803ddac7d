#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <string_view>
#include <system_error>
#include <tuple>
#include <utility>

#include "diagnostics/quote.hpp"
#include "network/assign_signals.hpp"
#include "network/dbc_names.hpp"
#include "network/master_sheet.hpp"
#include "network/network.hpp"
#include "network/node_settings.hpp"
#include "network/unused_pdos.hpp"
#include "system/path.hpp"

namespace edsc {
namespace {

namespace fs = std::filesystem;

class NetworkLoader {
 public:
  NetworkLoader(LoadedNetwork& loaded, Diagnostics& diagnostics, const ReadBase& read)
      : loaded_{loaded}, network_{loaded.network}, diagnostics_{diagnostics}, read_{read} {}

  void load() {
    for (const NodeDescription& node : network_.description.nodes) add_node(node);
    check_sync_producer();
    check_heartbeat_timeouts();
    for (NetworkNode& node : network_.nodes) {
      if (node.has_file()) apply_settings(node);
    }
    if (const WrittenText& dbc = network_.description.dbc) {
      if (!load_dbc(network_, beside_network_file(dbc->value), diagnostics_)) loaded_.unreadable = true;
    }
    const SignalPlan plan = plan_signals(network_, diagnostics_);
    for (NetworkNode& node : network_.nodes) {
      if (!node.has_file()) add_master_sheet(node, network_, plan);
    }
    for (NetworkNode& node : network_.nodes) {
      if (!node.has_file()) apply_settings(node);
      apply_signals(node, plan, diagnostics_);
      configure(node, *network_.source, diagnostics_);
    }
    disable_unused_pdos(network_, diagnostics_);
    apply_dbc_names(network_, diagnostics_);
  }

 private:
  /// The settings that do not depend on signals. Signals use the PDOs that they leave.
  void apply_settings(NetworkNode& node) {
    apply_sync(node, network_.description.sync, diagnostics_);
    apply_node_members(node, *network_.source, diagnostics_);
    apply_master_timeout(node, network_, diagnostics_);
    Diagnostics of_mapping;  // reported when the signals are assigned
    configure(node, *network_.source, of_mapping);
  }

  void add_node(const NodeDescription& description) {
    NetworkNode node;
    node.name = description.name.value;
    node.position = description.name.position;
    node.description = &description;
    node.is_master = description.master && description.master->value;
    if (description.node_id) node.node_id = static_cast<std::uint8_t>(description.node_id->value);
    if (!node.has_file() && !node.is_master) return;
    if (node.has_file() && !load_file(node)) return;
    if (node.node_id == 0) return;
    network_.nodes.push_back(std::move(node));
  }

  /// Loads the EDS or DCF of a node; false if it has no device.
  bool load_file(NetworkNode& node) {
    const NodeDescription& description = *node.description;
    const Written<std::string>& file = description.dcf ? *description.dcf : *description.eds;
    LoadSettings settings;
    settings.path = beside_network_file(file.value);
    if (description.options) settings.options_path = beside_network_file(description.options->value);
    settings.keep_going = description.keep_going && description.keep_going->value;
    if (node.node_id != 0) settings.node_id = node.node_id;
    settings.read = read_;
    settings.check = checked_.insert(settings.path).second;
    Diagnostics of_file;
    network_.files.push_back(load_device(settings, of_file));
    LoadedDevice& loaded = *network_.files.back();
    report_errors(of_file, file.position, loaded);
    if (!loaded.device) return false;
    node.loaded = &loaded;
    check_node_id(node, description);
    return true;
  }

  /// Without `..`, unless a symlink makes that another file.
  [[nodiscard]] std::string beside_network_file(const std::string& name) const {
    const fs::path path = to_native(network_.source->name()).parent_path() / to_native(name);
    const fs::path normal = path.lexically_normal();
    std::error_code missing;
    return from_native(fs::equivalent(path, normal, missing) ? normal : path);
  }

  void report_errors(const Diagnostics& of_file, const Position& file, const LoadedDevice& loaded) {
    if (loaded.unreadable) {
      for (const Diagnostic& one : of_file.all()) diagnostics_.error("network-file", file, one.message);
      loaded_.unreadable = true;
    } else {
      for (const Diagnostic& one : of_file.all()) {
        if (one.severity == Severity::error && is_new(one)) diagnostics_.report(one);
      }
    }
  }

  /// An error in a file of several nodes is reported once.
  bool is_new(const Diagnostic& one) {
    const std::string_view file = one.position.file != nullptr ? std::string_view{one.position.file->name()} : "";
    return reported_.emplace(file, one.position.line, one.position.column, one.message).second;
  }

  /// A DCF states the node-ID, which the network file may repeat.
  void check_node_id(NetworkNode& node, const NodeDescription& description) {
    if (description.node_id || !description.dcf) return;
    if (node.device().node_id) {
      node.node_id = *node.device().node_id;
    } else {
      diagnostics_.error("network-file", node.position,
                         fmt::format("node {} needs \"node_id\": its DCF has no NodeID", quote(node.name)));
    }
  }

  void check_sync_producer() {
    const WrittenText& producer = network_.description.sync.producer;
    if (!producer || network_.lists(producer->value)) return;
    diagnostics_.error("network-file", producer->position, network_.unknown_node(producer->value));
  }

  /// If the master has an EDS, its 1016h comes from the EDS and from `set`.
  void check_heartbeat_timeouts() {
    const NetworkNode* const master = network_.master();
    if (master != nullptr && !master->has_file()) return;
    for (const NetworkNode& node : network_.nodes) {
      const WrittenNumber& timeout = node.description->heartbeat_timeout_ms;
      if (!timeout) continue;
      diagnostics_.error("network-value", timeout->position,
                         "\"heartbeat_timeout_ms\" needs a master without a file; \"set\" 1016h of another consumer");
    }
  }

  using FindingKey = std::tuple<std::string, std::uint32_t, std::uint32_t, std::string>;

  LoadedNetwork& loaded_;
  Network& network_;
  Diagnostics& diagnostics_;
  const ReadBase& read_;
  std::set<std::string> checked_;  ///< files whose rules were checked
  std::set<FindingKey> reported_;  ///< errors in files of nodes
};

}  // namespace

std::unique_ptr<LoadedNetwork> load_network(const std::string& path, Diagnostics& diagnostics) {
  std::string problem;
  if (auto source = read_source_file(path, problem)) return load_network(std::move(source), diagnostics);
  auto loaded = std::make_unique<LoadedNetwork>();
  loaded->network.source = std::make_unique<SourceFile>(path, std::string{});
  diagnostics.error("unreadable-file", Position{loaded->network.source.get()}, problem);
  loaded->unreadable = true;
  return loaded;
}

std::unique_ptr<LoadedNetwork> load_network(std::unique_ptr<SourceFile> source, Diagnostics& diagnostics,
                                            const ReadBase& read) {
  auto loaded = std::make_unique<LoadedNetwork>();
  loaded->network.source = std::move(source);
  loaded->network.description = read_network_file(*loaded->network.source, diagnostics);
  NetworkLoader{*loaded, diagnostics, read}.load();
  return loaded;
}

}  // namespace edsc
