// expect: by value or as const& .*every_type::od::unsigned16_value
// A function cannot change the value that is written.
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
  void written(od::unsigned16_value, const std::uint16_t&) {}
#else
  void written(od::unsigned16_value, std::uint16_t&) {}
#endif
};

Bus bus;
bench::NodeOf<every_type::Device, Bus, Application> node{bus, canopen::NodeId{5}};
