// expect: none of these functions has an object of this device .*Application
// The first parameter of `written` is an object.
#include <canopen/node.hpp>
#include <every_type/device.hpp>

#include "support/omitting.hpp"

namespace od = every_type::od;

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

struct Application {
#ifdef GOOD
  void written(od::unsigned16_value, std::uint16_t) {}
#else
  void written(std::uint16_t) {}
#endif
};

Bus bus;
bench::NodeOf<every_type::Device, Bus, Application> node{bus, canopen::NodeId{5}};
