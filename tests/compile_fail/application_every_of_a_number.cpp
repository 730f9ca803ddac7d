// expect: first parameter of every is a period .*PeriodicFunctions<Application
// A periodic function whose period is not known at compile time.
#include <canopen/node.hpp>
#include <chrono>
#include <every_type/device.hpp>

#include "support/omitting.hpp"

using namespace std::chrono_literals;

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

struct Application {
#ifdef GOOD
  void every(canopen::Milliseconds<10>, auto&) {}
#else
  void every(std::chrono::milliseconds, auto&) {}
#endif
};

Bus bus;
bench::NodeOf<every_type::Device, Bus, Application> node{bus, canopen::NodeId{5}};
