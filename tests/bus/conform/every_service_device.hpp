/// The good device of these tests, with every service.
#pragma once

#include <canopen_sim/simulated_node.hpp>

namespace edsc::conform {

[[nodiscard]] canopen::MakeSimulatedNode every_service_device();

}  // namespace edsc::conform
