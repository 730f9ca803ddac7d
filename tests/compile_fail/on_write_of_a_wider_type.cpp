// expect: its parameter is not of the type of its object .*every_type::od::unsigned16_value
// A handler with a parameter that does not hold all values of its object.
#include <canopen/node.hpp>
#include <every_type/device.hpp>

#include "support/omitting.hpp"

namespace od = every_type::od;

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

Bus bus;
#ifdef GOOD
auto handler = canopen::on_write(od::unsigned16_value{}, [](std::uint16_t) {});
#else
auto handler = canopen::on_write(od::unsigned16_value{}, [](std::uint8_t) {});
#endif
bench::NodeOf<every_type::Device, Bus, decltype(handler)> node{bus, canopen::NodeId{5}, handler};
