/// Firmware of one device: its node uses SLCAN on the board's serial line, its parameters are in flash, and it has LSS
/// if the build does not set a node-ID.
#include <canopen/node.hpp>
#include <canopen/storage/flash_storage.hpp>

#include "board.hpp"
#include "firmware_parts.hpp"
#include "lss_settings.hpp"
#include "serial_bus.hpp"

namespace {

using Device = EDSC_DEVICE;

constinit SerialBus bus;

board::Flash parameter_pages{0};
constinit canopen::FlashStorage storage{parameter_pages};

board::Flash lss_pages{1};
constinit LssSettings lss{lss_pages};

/// With storage if the device has 1010h, and with LSS if it has LSS and the build does not set a node-ID.
template <class D>
auto make_node() {
  constexpr bool stores = canopen::part::storage::is_promised<D>;
#ifdef EDSC_NODE_ID
  if constexpr (stores) return canopen::make_node<PartsOf<D>>(bus, canopen::stored_in(storage));
  if constexpr (!stores) return canopen::make_node<PartsOf<D>>(bus);
#else
  const auto by_lss = canopen::configured_by_lss(lss);
  if constexpr (stores) return canopen::make_node<PartsOf<D>>(bus, canopen::stored_in(storage), by_lss);
  if constexpr (!stores) return canopen::make_node<PartsOf<D>>(bus, by_lss);
#endif
}

/// Initialized at power-on: a constant-initialized node with references also takes flash for its initial values.
auto node = make_node<Device>();

canopen::NodeId node_id() {
#ifdef EDSC_NODE_ID
  return canopen::NodeId{EDSC_NODE_ID};
#else
  lss.open();
  return lss.node_id();
#endif
}

}  // namespace

int main() {
  board::start();
  node.start(node_id(), board::now());
  for (;;) {
    const std::optional<canopen::Frame> frame = bus.receive();
    const canopen::TimePoint now = board::now();
    if (frame) node.on_frame(*frame, now);
    node.on_time(now);
  }
}
