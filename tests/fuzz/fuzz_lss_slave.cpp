/// Whatever frames it receives, an LSS slave sends well-formed responses and stays in a valid state.
///
/// An input is a sequence of steps of ten bytes: an additional action, the time that passes, and the data of a frame.
#include <algorithm>
#include <canopen/lss/lss_slave.hpp>

#include "fuzz.hpp"

namespace edsc::fuzz {
namespace {

using canopen::Frame;
using canopen::LssBitTiming;
using canopen::LssError;
using canopen::LssState;
using canopen::NmtState;
using canopen::NodeId;
using canopen::TimePoint;

struct Device {
  bool send(const Frame& frame) {
    require(!slave.silent(), "a slave that switches its bit rate sends nothing");
    require(frame.id == 0x7E4 && frame.size == 8 && !frame.extended && !frame.remote, "answers are LSS frames");
    require(frame.data[5] == 0 && frame.data[6] == 0 && frame.data[7] == 0, "reserved bytes are 0");
    return true;
  }

  void reset_communication() {
    const NodeId node_id = slave.reset_communication();
    slave.enter(NmtState::initialisation);
    if (node_id.valid()) slave.enter(NmtState::pre_operational);
  }

  void check() const {
    require(slave.state() == LssState::waiting || slave.state() == LssState::configuration, "a slave has two states");
    for (const NodeId node_id : {slave.node_id(), slave.pending_node_id(), slave.persistent_node_id()}) {
      require(node_id.valid() || node_id == canopen::unconfigured_node_id, "node-IDs are 1..127 or 255");
    }
    require(slave.persistent_node_id() == stored, "the persistent node-ID is the one that is stored");
    require(!slave.silent() || off_bus, "a silent slave is off the bus");
  }

  canopen::LssSlave<canopen::LssOptions{.manufacturer_bit_timing = true}> slave;
  NodeId stored = canopen::unconfigured_node_id;
  LssError error{};
  bool off_bus = false;
};

struct Hooks {
  Device& device;
  std::uint32_t identity(std::uint8_t sub_index) {
    require(sub_index >= 1 && sub_index <= 4, "1018h has four numbers");
    return sub_index;
  }
  LssError accept(NodeId) { return device.error; }
  LssError accept(LssBitTiming bit_timing) {
    require(bit_timing.table >= 128 || (bit_timing.table == 0 && bit_timing.index <= 8 && bit_timing.index != 5),
            "a bit rate is one of the options");
    return device.error;
  }
  LssError store(NodeId node_id, LssBitTiming) {
    if (device.error.code == 0) device.stored = node_id;
    return device.error;
  }
  void reset_communication() { device.reset_communication(); }
  void stop_communication() {
    require(!device.off_bus, "a device leaves the bus once");
    device.off_bus = true;
  }
  void start_communication(LssBitTiming) {
    require(device.off_bus, "a device that comes back has left");
    device.off_bus = false;
  }
};

constexpr NmtState states[] = {NmtState::initialisation, NmtState::stopped, NmtState::operational,
                               NmtState::pre_operational};

void happen(Device& device, std::uint8_t what) {
  device.error = {static_cast<std::uint8_t>((what & 0x40) != 0 ? 2 : 0), 0};
  if ((what & 0x0C) == 0x04) device.reset_communication();
  if ((what & 0x0C) == 0x08) device.slave.enter(states[what & 3]);
  if ((what & 0x1C) == 0x1C) device.slave.reset_application();
}

}  // namespace
}  // namespace edsc::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace edsc::fuzz;
  constexpr std::size_t step = 10;
  Device device;
  TimePoint now{};
  device.slave.start(device.stored, {});
  device.reset_communication();
  for (; size >= step; data += step, size -= step) {
    happen(device, data[0]);
    now = now + canopen::from_milliseconds(static_cast<std::uint16_t>(data[1] * data[1]));
    device.slave.on_time(Hooks{device}, now);
    Frame frame{.id = 0x7E5, .size = static_cast<std::uint8_t>((data[0] & 0x80) != 0 ? 7 : 8)};
    std::copy_n(data + 2, frame.data.size(), frame.data.begin());
    device.slave.on_frame(frame, Hooks{device}, now);
    require(device.slave.serve(device) || device.slave.silent(), "an answer waits for a silent slave only");
    device.check();
  }
  return 0;
}
