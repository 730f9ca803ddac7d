// expect: does not call a function of this name .*OnChange
// A name that the node does not call, beside a function that it calls.
#include <canopen/node.hpp>
#include <every_type/device.hpp>

#include "support/omitting.hpp"

namespace od = every_type::od;

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

struct Application {
  void written(od::unsigned16_value, std::uint16_t) {}
#ifndef GOOD
  void on_change(od::access_rw, std::uint16_t) {}
#endif
};

Bus bus;
bench::NodeOf<every_type::Device, Bus, Application> node{bus, canopen::NodeId{5}};
