/// The master of a host: boots and monitors slaves, reads and writes their objects and exchanges PDOs with them.
#pragma once

#include "canopen/host/master.hpp"
