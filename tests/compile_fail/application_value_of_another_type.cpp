// expect: parameter of this function is not of the type of its object .*every_type::od::unsigned16_value
// A function of an application has the type of its object as a parameter.
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
  void written(od::unsigned16_value, float) {}
#endif
};

Bus bus;
bench::NodeOf<every_type::Device, Bus, Application> node{bus, canopen::NodeId{5}};
