// expect: or \(object, value, node\) .*every_type::od::unsigned16_value
// One function without a value is noticed beside another one that is called.
#include <canopen/node.hpp>
#include <every_type/device.hpp>

#include "support/omitting.hpp"

namespace od = every_type::od;

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

struct Application {
  void written(od::unsigned8_value, std::uint8_t) {}
#ifdef GOOD
  void written(od::unsigned16_value, std::uint16_t, auto&) {}
#else
  void written(od::unsigned16_value) {}
#endif
};

Bus bus;
bench::NodeOf<every_type::Device, Bus, Application> node{bus, canopen::NodeId{5}};
