// expect: first parameter of every is a period .*PeriodicFunctions<Application
// A template of periods beside a function: the node does not know which periods are meant.
#include <canopen/node.hpp>
#include <cstdint>
#include <every_type/device.hpp>

#include "support/omitting.hpp"

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

struct Application {
#ifdef GOOD
  void every(canopen::Milliseconds<10>, auto&) {}
#else
  void every(canopen::Milliseconds<10>, auto&) {}
  template <std::uint64_t microseconds>
  void every(canopen::Microseconds<microseconds>) {}
#endif
};

Bus bus;
bench::NodeOf<every_type::Device, Bus, Application> node{bus, canopen::NodeId{5}};
