/// Compares the nodes of a network file with those on a bus, and configures them.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "configure/configuration_run.hpp"
#include "network/network.hpp"
#include "online/bus_watch.hpp"
#include "online/identity.hpp"
#include "online/live_bus.hpp"
#include "online/sdo_access.hpp"

namespace edsc {

/// Why a node cannot be configured or started.
struct NodeProblem {
  std::string text;   ///< with the name of the node
  Position position;  ///< the line that it contradicts: of the network file, or of the EDS
};

/// A node of the network file, and what was found on the bus.
struct LiveNode {
  const NetworkNode* node = nullptr;
  Configuration configuration;
  std::unique_ptr<SdoAccess> access;
  bool answers = false;
  Identity identity;                                      ///< found
  bool is_compared = false;                               ///< its values were read
  ConfigurationRun run;                                   ///< the comparison, and the last attempt to configure it
  std::optional<unsigned> sdo_timeout_ms = std::nullopt;  ///< of the network file
  unsigned attempts = 0;                                  ///< to configure it
  unsigned boot_ups = 0;                                  ///< seen before the last comparison
  unsigned foreign_commands = 0;  ///< of another NMT master, as many as before the last comparison
  bool started = false;           ///< by this session
  std::vector<NodeProblem> problems;

  /// Whether it was configured.
  [[nodiscard]] bool succeeded() const { return attempts != 0 && problems.empty() && run.succeeded(); }
};

enum class OnError : std::uint8_t {
  abort,       ///< do not write to further nodes
  keep_going,  ///< configure the other nodes
  retry,       ///< configure the node again, then abort
};

struct ApplySettings {
  bool store = false;
  bool start = false;
  OnError on_error = OnError::abort;
  unsigned retries = 3;
};

/// Callbacks of a session.
struct NetworkHooks {
  /// Before each transfer: the node, what is done, and how far.
  std::function<void(const LiveNode& node, std::string_view doing, std::size_t done, std::size_t of)> progress;
  /// After the differences of a node are known, and before they are written.
  std::function<void(const LiveNode& node)> compared;
  /// After the last attempt to configure a node.
  std::function<void(const LiveNode& node)> configured;
};

/// The nodes of a network that have a file, on a bus. All functions throw Interrupted, BusLost.
class NetworkSession {
 public:
  /// `nodes` must outlive the session; their members `node`, `configuration` and `sdo_timeout_ms` are set. `sdo` has
  /// the time-out of the other nodes.
  NetworkSession(LiveBus& bus, std::vector<LiveNode>& nodes, SdoSettings sdo, NetworkHooks hooks);

  /// Reads the identity of all nodes. Missing nodes, other products, nodes that cannot be identified, and node-IDs of
  /// two nodes become problems. Returns false if there are any. A node that does not answer is set to Pre-operational
  /// first if `wakes`: it may be in Stopped.
  bool identify(bool wakes);

  /// Reads the configured values of the nodes without a problem. Returns false if there is a problem.
  bool compare();

  /// After `identify` and `compare` without problems: configures the nodes in Pre-operational. Stores the parameters of
  /// the nodes that succeeded, unless an error aborts. Reads all values again and measures the heartbeats, then starts
  /// all nodes, if all succeeded; returns whether they did.
  bool apply(const ApplySettings& settings);

 private:
  void identify(LiveNode& live, bool wakes);
  void compare(LiveNode& live);
  void check_extra_responses();
  void check_foreign_commands();
  void begin_again(LiveNode& live);
  void write(LiveNode& live);
  void configure(LiveNode& live, const ApplySettings& settings);
  void configure_all(const ApplySettings& settings);
  void store_all();
  void check_presence();
  void check_values();
  void check_heartbeats();
  void start_all();
  void check_restarts(const ApplySettings& settings);
  static void add_problem(LiveNode& live, std::string_view text);
  ConfigurationHooks hooks_for(const LiveNode& live, std::string_view doing) const;
  [[nodiscard]] bool has_restarted(const LiveNode& live) const;
  [[nodiscard]] bool has_problems() const;
  [[nodiscard]] bool all_succeeded() const;

  LiveBus& bus_;
  std::vector<LiveNode>& nodes_;
  NetworkHooks hooks_;
  SdoSettings sdo_;
  BusWatch watch_;
};

}  // namespace edsc
