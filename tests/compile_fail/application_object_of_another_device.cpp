// expect: this device does not have the object of one of its functions .*function::Written
// A function of an application for an object of another device.
#include <canopen/node.hpp>
#include <every_type/device.hpp>
#include <sdo_device/device.hpp>

#include "support/omitting.hpp"

namespace od = every_type::od;

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

struct Application {
  void written(od::unsigned16_value, std::uint16_t) {}
#ifndef GOOD
  void written(sdo_device::od::firmware, canopen::Domain) {}
  void written(sdo_device::od::log, canopen::Domain, auto&) {}
#endif
};

Bus bus;
bench::NodeOf<every_type::Device, Bus, Application> node{bus, canopen::NodeId{5}};
