/// The old include path of canopen_sim/network_simulation/heartbeat_watch.hpp, which is removed after version 0.9.
#pragma once

#include "canopen_sim/network_simulation/heartbeat_watch.hpp"
