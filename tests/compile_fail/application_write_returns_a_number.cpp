// expect: write returns an AbortCode .*every_type::od::unsigned16_value
// `write` accepts or rejects a value.
#include <canopen/node.hpp>
#include <every_type/device.hpp>

#include "support/omitting.hpp"

namespace od = every_type::od;

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

struct Application {
#ifdef GOOD
  canopen::Result<void> write(od::unsigned16_value, std::uint16_t) { return canopen::ok; }
#else
  int write(od::unsigned16_value, std::uint16_t) { return 0; }
#endif
};

Bus bus;
bench::NodeOf<every_type::Device, Bus, Application> node{bus, canopen::NodeId{5}};
