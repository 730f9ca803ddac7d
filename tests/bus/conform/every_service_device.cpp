#include "every_service_device.hpp"

#include <canopen_sim/simulated_node.hpp>
#include <every_service/device.hpp>

namespace edsc::conform {

canopen::MakeSimulatedNode every_service_device() { return canopen::make_simulated_node<every_service::Device>; }

}  // namespace edsc::conform
