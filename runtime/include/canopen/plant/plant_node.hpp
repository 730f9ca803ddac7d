/// The old include path of canopen_plant/plant_node.hpp, which is removed after version 0.9.
#pragma once

#include "canopen_plant/plant_node.hpp"
