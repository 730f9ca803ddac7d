/// The drawings of a network as SVG files.
#pragma once

#include <string>
#include <vector>

#include "network/network.hpp"
#include "system/write_files.hpp"

namespace edsc {

/// Returns `NAME.svg`, the message flow, and `NAME_cycle.svg`, the frames of a SYNC cycle with their worst-case
/// response times, if SYNC has a period and the network a bit rate. They are the drawings of its page (document_of),
/// with a title and a description, for a light and a dark background. NAME is that of the network file.
[[nodiscard]] std::vector<OutputFile> network_drawings(const Network& network);

}  // namespace edsc
