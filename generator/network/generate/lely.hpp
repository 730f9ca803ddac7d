/// The files of a network for a master with Lely's CANopen library, such as that of ros2_canopen.
#pragma once

#include <string>
#include <vector>

#include "format/document.hpp"
#include "network/network.hpp"
#include "system/write_files.hpp"

namespace edsc {

/// The configuration of a node as `make_node_dcf` returns it.
struct LelyNode {
  const NetworkNode* node = nullptr;
  Document dcf;
  std::string concise_dcf;
};

struct LelyFiles {
  OutputFile bus_yml;              ///< the input of Lely's dcfgen and of ros2_canopen
  OutputFile master_dcf;           ///< of the master, as Lely's loader accepts it
  std::vector<std::string> notes;  ///< values that `bus.yml` cannot hold: `axis1: 2001h:00 Label (VISIBLE_STRING)`
};

/// The DCF of a node: `NAME.dcf`, but not `master.dcf`, which dcfgen writes.
[[nodiscard]] std::string lely_dcf_file(const NetworkNode& node);

/// Lely's loader takes a file that the master sends from UploadFile of an entry that can only be read, and its master
/// does not need SDO client parameters (1280h to 12FFh), which it would otherwise use in place of the default ones.
/// dcfgen adds a PDO to the master for each PDO of the DCFs, and writes the values of `sdo` to the nodes in this order.
[[nodiscard]] LelyFiles lely_files(const Network& network, const NetworkNode& master, std::vector<LelyNode> nodes);

}  // namespace edsc
