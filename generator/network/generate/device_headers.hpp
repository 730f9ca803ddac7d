/// The headers of the devices of a network, as `edsc generate` writes them.
#pragma once

#include <string>
#include <vector>

#include "network/network.hpp"
#include "system/write_files.hpp"

namespace edsc {

struct DeviceHeaders {
  std::vector<OutputFile> files;
  std::vector<std::string> names;  ///< namespace and folder of the device of each node, in the order of the nodes
};

/// Generates the headers of each EDS or DCF once, with the values of the file; nodes with the same file, options and
/// `keep_going` share them. Those of a master have the values of the network, because it is that device. Namespaces are
/// those of the file names, and differ from `taken`.
[[nodiscard]] DeviceHeaders device_headers(const Network& network, const std::string& taken, Diagnostics& diagnostics);

}  // namespace edsc
