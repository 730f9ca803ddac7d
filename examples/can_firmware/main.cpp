/// Firmware of one device on a CAN bus: its node with the board's CAN controller, its parameters in flash, and LSS if
/// the build does not set a node-ID. The build and the parts are tested, but the firmware has not yet run on a board.
#include <array>
#include <canopen/node.hpp>
#include <canopen/node/accepted_frames.hpp>
#include <canopen/storage/flash_storage.hpp>
#include <optional>
#include <span>

#include "../firmware/firmware_parts.hpp"
#include "board.hpp"
#include "can.hpp"
#include "can_lss.hpp"

namespace {

using Device = EDSC_DEVICE;

board::Can can = board::make_can();

board::Flash parameter_pages{0};
constinit canopen::FlashStorage storage{parameter_pages};

#ifndef EDSC_NODE_ID
board::Flash lss_pages{1};
CanLss lss{lss_pages, can};
#endif

/// With storage if the device has 1010h, and with LSS if it has LSS and the build does not set a node-ID.
template <class D>
auto make_node() {
  constexpr bool stores = canopen::part::storage::is_promised<D>;
#ifdef EDSC_NODE_ID
  if constexpr (stores) return canopen::make_node<PartsOf<D>>(can, canopen::stored_in(storage));
  if constexpr (!stores) return canopen::make_node<PartsOf<D>>(can);
#else
  const auto by_lss = canopen::configured_by_lss(lss);
  if constexpr (stores) return canopen::make_node<PartsOf<D>>(can, canopen::stored_in(storage), by_lss);
  if constexpr (!stores) return canopen::make_node<PartsOf<D>>(can, by_lss);
#endif
}

auto node = make_node<Device>();

/// Starts the CAN controller and returns the node-ID.
canopen::NodeId start_can() {
#ifdef EDSC_NODE_ID
  (void)can.start(board::can_clock, 125'000);
  return canopen::NodeId{EDSC_NODE_ID};
#else
  lss.open();
  lss.start_communication(lss.bit_timing());
  return lss.node_id();
#endif
}

/// Sets the acceptance filters again when the COB-IDs have changed, by SDO or LSS.
class Filters {
 public:
  void follow() {
    Frames frames{};
    std::size_t count = 0;
    canopen::for_each_accepted_frame(node, [&](const canopen::AcceptedFrame& frame) { frames[count++] = frame; });
    if (count == count_ && frames == frames_) return;
    frames_ = frames;
    count_ = count;
    can.accept(std::span{frames_}.first(count_));
  }

 private:
  using Frames = std::array<canopen::AcceptedFrame, canopen::max_accepted_frames<Device>>;

  Frames frames_{};
  std::size_t count_ = 0;
};

constinit Filters filters;

}  // namespace

int main() {
  board::start();
  node.start(start_can(), board::now());
  for (;;) {
    const std::optional<canopen::Frame> frame = can.receive();
    const canopen::TimePoint now = board::now();
    if (frame) node.on_frame(*frame, now);
    if (const auto status = can.status_change()) node.on_bus_status(*status, now);
    node.on_time(now);
    filters.follow();
  }
}
