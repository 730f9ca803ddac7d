/// The old include path of canopen_sim/simulated_node.hpp, which is removed after version 0.9.
#pragma once

#include "canopen_sim/simulated_node.hpp"
