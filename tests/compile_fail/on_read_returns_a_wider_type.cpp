// expect: on_read: the handler returns the type of its object .*every_type::od::unsigned16_value
// A handler that returns `int`, which would be truncated.
#include <canopen/node.hpp>
#include <every_type/device.hpp>

#include "support/omitting.hpp"

namespace od = every_type::od;

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

int measure();
Bus bus;
#ifdef GOOD
auto handler = canopen::on_read(od::unsigned16_value{}, [] { return static_cast<std::uint16_t>(measure()); });
#else
auto handler = canopen::on_read(od::unsigned16_value{}, [] { return measure(); });
#endif
bench::NodeOf<every_type::Device, Bus, decltype(handler)> node{bus, canopen::NodeId{5}, handler};
