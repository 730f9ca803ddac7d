// expect: Application::write
// The result of a function with the node is stated: the compiler would need the body before the node is complete.
#include <canopen/node.hpp>
#include <every_type/device.hpp>

#include "support/omitting.hpp"

namespace od = every_type::od;

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

struct Application {
#ifdef GOOD
  void write(od::unsigned16_value, std::uint16_t, auto& node) { node.set(od::access_rw{}, 5); }
#else
  auto write(od::unsigned16_value, std::uint16_t, auto& node) { return node.set(od::access_rw{}, 5); }
#endif
};

Bus bus;
bench::NodeOf<every_type::Device, Bus, Application> node{bus, canopen::NodeId{5}};
