/// The nodes of a network file for the commands at a live bus.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "monitor/progress_line.hpp"
#include "network/network.hpp"
#include "network/network_session.hpp"
#include "shared/command_line.hpp"

namespace edsc {

/// Arguments of `edsc network verify` and `edsc network apply`.
struct LiveNetworkSettings {
  std::string bus;
  std::string path;
  std::vector<std::string> skip;  ///< names of nodes
  SdoSettings sdo;
  std::string format = "text";
};

/// `BUS FILE`, `--skip`, `--format` and `--timeout`.
void add_live_network_options(Command command, LiveNetworkSettings& settings);

struct LiveNetwork {
  std::unique_ptr<LoadedNetwork> loaded;
  std::vector<LiveNode> nodes;  ///< those with a file that are not skipped
};

/// Reads and checks the network file. Prints its errors, and ends the command if there are any.
[[nodiscard]] LiveNetwork load_live_network(const LiveNetworkSettings& settings);

/// A callback that shows the progress on a terminal.
[[nodiscard]] decltype(NetworkHooks::progress) show_progress(ProgressLine& line, const std::vector<LiveNode>& nodes);

/// Prints which numbers of the identities could not be compared, and other minor revisions.
void report_identities(const std::vector<LiveNode>& nodes);

}  // namespace edsc
