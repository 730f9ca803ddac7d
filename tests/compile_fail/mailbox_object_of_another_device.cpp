// expect: object of another device .*other::od::target_torque
// A mailbox with an object of another device that has the index and the type of an object of this one.
#include <canopen/node.hpp>
#include <canopen/node/mailbox.hpp>
#include <every_type/device.hpp>

#include "support/omitting.hpp"

namespace od = every_type::od;

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

namespace other::od {
struct target_torque : canopen::TypedObject<std::uint16_t, canopen::Access::rw> {
  static constexpr std::uint16_t index = every_type::od::access_rw::index;
  static constexpr std::uint8_t sub_index = 0;
  static constexpr auto name = "Target torque";
};
}  // namespace other::od

#ifdef GOOD
using checked_object = od::access_rw;
#else
using checked_object = other::od::target_torque;
#endif

void run(Bus& bus, canopen::Mailbox<checked_object>& measured) {
  auto node = bench::make_node<every_type::Device>(bus, canopen::NodeId{5}, canopen::values_from(measured));
  node.on_time(canopen::TimePoint{});
}
