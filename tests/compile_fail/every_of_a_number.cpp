// expect: every: the period is known at compile time .*duration
// A period that is not known at compile time.
#include <canopen/node.hpp>
#include <chrono>
#include <every_type/device.hpp>

#include "support/omitting.hpp"

using namespace std::chrono_literals;

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

Bus bus;
#ifdef GOOD
auto node =
    bench::make_node<every_type::Device>(bus, canopen::NodeId{5}, canopen::every(canopen::Milliseconds<10>{}, [] {}));
#else
auto node = bench::make_node<every_type::Device>(bus, canopen::NodeId{5}, canopen::every(10ms, [] {}));
#endif
