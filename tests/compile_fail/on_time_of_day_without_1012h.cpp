// expect: on_time_of_day: this device does not have 1012h
// A handler of a service needs the object of the service.
#include <canopen/node.hpp>
#include <every_service/device.hpp>
#include <sdo_device/device.hpp>

#include "support/omitting.hpp"

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

auto make(Bus& bus) {
#ifdef GOOD
  using Device = every_service::Device;
#else
  using Device = sdo_device::Device;
#endif
  return bench::make_node<Device>(bus, canopen::NodeId{5}, canopen::on_time_of_day([](canopen::TimeOfDay) {}));
}
