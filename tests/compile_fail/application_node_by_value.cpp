// expect: or \(object, value, node\) .*every_type::od::unsigned16_value
// A node cannot be copied: the parameter is `auto& node`.
#include <canopen/node.hpp>
#include <every_type/device.hpp>

#include "support/omitting.hpp"

namespace od = every_type::od;

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

struct Application {
#ifdef GOOD
  void written(od::unsigned16_value, std::uint16_t, auto& node) { node.set(od::access_rw{}, 5); }
#else
  void written(od::unsigned16_value, std::uint16_t, auto node) { node.set(od::access_rw{}, 5); }
#endif
};

Bus bus;
bench::NodeOf<every_type::Device, Bus, Application> node{bus, canopen::NodeId{5}};
