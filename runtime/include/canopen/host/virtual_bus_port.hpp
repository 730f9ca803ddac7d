/// The old include path of canopen_sim/virtual_bus_port.hpp, which is removed after version 0.9.
#pragma once

#include "canopen_sim/virtual_bus_port.hpp"
