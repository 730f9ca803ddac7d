/// A station that runs a device's application, the one of examples/nodes.
#pragma once

#include <canopen/node_id.hpp>
#include <memory>
#include <string_view>

#include "station.hpp"

namespace trace {

/// Nothing: there is no such application. `name` is that of the device's data sheet.
[[nodiscard]] std::unique_ptr<Station> make_application(std::string_view name, canopen::NodeId node_id);

}  // namespace trace
