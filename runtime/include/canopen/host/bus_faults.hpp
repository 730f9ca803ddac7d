/// The old include path of canopen_sim/bus_faults.hpp, which is removed after version 0.9.
#pragma once

#include "canopen_sim/bus_faults.hpp"
