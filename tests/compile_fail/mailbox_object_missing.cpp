// expect: values_from: this device does not have an object of the mailbox
#include <canopen/node.hpp>
#include <canopen/node/mailbox.hpp>
#include <every_type/device.hpp>

#include "support/omitting.hpp"

namespace od = every_type::od;

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

#ifdef GOOD
using Posted = od::integer16_value;
#else
struct Posted : canopen::Object<0x5FFF, 0x00, std::int16_t, canopen::Access::ro> {
  static constexpr auto name = "of another device";
};
#endif

void run(Bus& bus, canopen::Mailbox<Posted>& measured) {
  auto node = bench::make_node<every_type::Device>(bus, canopen::NodeId{5}, canopen::values_from(measured));
  node.on_time(canopen::TimePoint{});
}
