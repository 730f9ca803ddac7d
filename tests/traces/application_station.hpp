/// A station that runs the application of a device, as in examples/nodes.
#pragma once

#include <canopen/can/node_id.hpp>
#include <memory>
#include <string_view>

#include "station.hpp"

namespace trace {

/// Returns null if the application does not exist. `name` is that of the EDS.
[[nodiscard]] std::unique_ptr<Station> make_application(std::string_view name, canopen::NodeId node_id);

}  // namespace trace
