// expect: read returns the type of its object .*every_type::od::unsigned16_value
// `read` returns a value of its object.
#include <canopen/node.hpp>
#include <every_type/device.hpp>

#include "support/omitting.hpp"

namespace od = every_type::od;

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

struct Application {
#ifdef GOOD
  std::uint16_t read(od::unsigned16_value) { return 0; }
#else
  float read(od::unsigned16_value) { return 0; }
#endif
};

Bus bus;
bench::NodeOf<every_type::Device, Bus, Application> node{bus, canopen::NodeId{5}};
