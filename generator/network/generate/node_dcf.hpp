/// The configuration of a node of a network as a DCF and as a concise DCF.
#pragma once

#include <string>
#include <string_view>

#include "format/document.hpp"
#include "network/network.hpp"

namespace edsc {

struct NodeDcf {
  std::string text;
  Document document;    ///< of the text
  std::string concise;  ///< bytes for 1F22h of the master (CiA 302-3)
};

/// The file of the node in canonical form, with [DeviceComissioning] of the network and a ParameterValue for each entry
/// that the network file or the DCF of the node configures; of a PDO mapping all values. 1F22h of a master refers to
/// the concise DCFs of the other nodes. A value that a DCF cannot express is reported. `file` is the name of the DCF.
[[nodiscard]] NodeDcf make_node_dcf(const Network& network, const NetworkNode& node, const std::string& file,
                                    Diagnostics& diagnostics);

/// `NAME.dcf`, with `_` in place of characters that file names cannot have everywhere.
[[nodiscard]] std::string node_file(const NetworkNode& node, std::string_view extension);

}  // namespace edsc
