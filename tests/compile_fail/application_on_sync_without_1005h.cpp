// expect: does not have the object that this event needs .*'1', '0', '0', '5', 'h'
// A device without 1005h never calls on_sync.
#include <canopen/node.hpp>
#include <every_service/device.hpp>
#include <sdo_device/device.hpp>

#include "support/omitting.hpp"

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

struct Application {
  void on_sync(std::uint8_t) {}
};

Bus bus;
#ifdef GOOD
using Device = every_service::Device;
#else
using Device = sdo_device::Device;
#endif
bench::NodeOf<Device, Bus, Application> node{bus, canopen::NodeId{5}};
