// expect: the object is ro or const .*every_type::od::access_ro
// The bus cannot write an ro object.
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
  void written(od::access_ro, std::uint16_t) {}
#endif
};

Bus bus;
bench::NodeOf<every_type::Device, Bus, Application> node{bus, canopen::NodeId{5}};
