/// One EDS, generated with mappings that SDO may change and with fixed ones: while no mapping is written, both nodes
/// send the same frames and have the same values, whatever they receive. Values stay inside their limits, and neither
/// sends on a CAN-ID that CiA 301 restricts.
///
/// An input is a sequence of steps of twelve bytes: an action, a choice, eight bytes of data, and two numbers.
#include <canopen/node.hpp>
#include <pdo_device/device.hpp>
#include <static_pdo_device/device.hpp>

#include <cstring>
#include <vector>

#include "fuzz.hpp"
#include "steps.hpp"
#include "support/omitting.hpp"

namespace edsc::fuzz {
namespace {

using canopen::Frame;
using canopen::NodeId;
using canopen::TimePoint;

[[nodiscard]] bool is_restricted(std::uint32_t id) {
  return id <= 0x07F || (id >= 0x101 && id <= 0x180) || (id >= 0x581 && id <= 0x5FF) || (id >= 0x601 && id <= 0x67F) ||
         (id >= 0x6E0 && id <= 0x6FF) || id >= 0x701;
}

struct Bus {
  std::vector<Frame> sent{};
  Room room{};
  bool send(const Frame& frame) {
    require(frame.size <= 8 && !frame.remote, "data frames have up to eight bytes");
    const bool own = frame.id == 0x585 || frame.id == 0x705;
    require(frame.extended || own || !is_restricted(frame.id), "no service uses a restricted CAN-ID");
    if (!room.take()) return false;
    sent.push_back(frame);
    return true;
  }
};

// Entries that exist in both devices and do not belong to a mapping.
constexpr std::uint32_t entries[] = {0x100000, 0x100100, 0x100300, 0x100301, 0x100500, 0x101400, 0x101500, 0x101700,
                                     0x101900, 0x140001, 0x140002, 0x140005, 0x140101, 0x140102, 0x140105, 0x140201,
                                     0x180001, 0x180002, 0x180003, 0x180005, 0x180006, 0x180101, 0x180102, 0x180103,
                                     0x180201, 0x180202, 0x180206, 0x180301, 0x200000, 0x200100, 0x200200, 0x200300,
                                     0x200401, 0x200408, 0x200500, 0x200800};
constexpr std::uint16_t can_ids[] = {0x000, 0x080, 0x080, 0x205, 0x205, 0x305, 0x405,
                                     0x605, 0x605, 0x605, 0x185, 0x285, 0x385};
constexpr std::uint8_t nmt_commands[] = {1, 1, 1, 2, 128, 129, 130};

[[nodiscard]] Frame frame_of(const Step& step) {
  Frame frame{.id = can_ids[step.choice % std::size(can_ids)], .size = 8};
  std::memcpy(frame.data.data(), step.data.data(), 8);
  if ((step.number & 0x80) != 0) frame.size = step.number % 9;
  frame.remote = (step.number & 0x70) == 0x70;
  if ((step.number & 0x0F) == 0x0F) std::memcpy(&frame.id, &step.data[4], sizeof frame.id);
  frame.extended = frame.id > 0x7FF;
  frame.id &= 0x1FFF'FFFF;
  if (frame.id == 0x000) {
    frame.data[0] = nmt_commands[step.other % std::size(nmt_commands)];
    frame.data[1] = 0;
  }
  if (frame.id == 0x605) {  // an upload, or a download of a suitable kind, never of a mapping
    const std::uint32_t entry = entries[step.other % std::size(entries)];
    canopen::sdo::put_multiplexer(frame.data, static_cast<std::uint16_t>(entry >> 8), static_cast<std::uint8_t>(entry));
    constexpr std::uint8_t commands[] = {0x40, 0x23, 0x2B, 0x2F, 0x27, 0x22, 0x21, 0x80, 0x60, 0x00};
    frame.data[0] = commands[step.data[0] % std::size(commands)];
    if ((step.choice & 0x80) != 0) frame.data[6] = frame.data[7] = 0;
  }
  return frame;
}

template <class Node>
[[nodiscard]] std::vector<std::uint8_t> value_of(Node& node, std::uint32_t entry) {
  const auto access = node.entries();
  std::array<std::uint8_t, 8> scratch{};
  const auto bytes =
      access.read(access.find(static_cast<std::uint16_t>(entry >> 8), static_cast<std::uint8_t>(entry)), scratch);
  return {bytes.begin(), bytes.end()};
}

template <class Node>
void check_limits(Node& node) {
  require(value_of(node, 0x200500)[0] <= 100, "a limit holds");
  for (std::uint32_t sub_index = 1; sub_index <= 8; ++sub_index) {
    require(value_of(node, 0x200400 + sub_index)[0] <= 1, "a BOOLEAN is 0 or 1");
  }
}

}  // namespace
}  // namespace edsc::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace edsc::fuzz;
  Bus dynamic_bus;
  Bus static_bus;
  bench::NodeOf<pdo_device::Device, Bus> dynamic_node{dynamic_bus, NodeId{5}};
  bench::NodeOf<static_pdo_device::Device, Bus> static_node{static_bus, NodeId{5}};
  TimePoint now{};
  dynamic_node.start(now);
  static_node.start(now);
  for (const Step& step : Steps{data, size}) {
    switch (step.what % 8) {
      case 0:
      case 1:
      case 2:
      case 3: {
        const Frame frame = frame_of(step);
        dynamic_node.on_frame(frame, now);
        static_node.on_frame(frame, now);
        break;
      }
      case 4:
      case 5: {
        const auto deadline = dynamic_node.next_deadline();
        require(deadline == static_node.next_deadline(), "both want to be called at the same time");
        if ((step.choice & 1) == 0) now = now + canopen::Duration{step.number * 500u};
        if ((step.choice & 1) != 0 && deadline && *deadline > now) now = *deadline;
        dynamic_node.on_time(now);
        static_node.on_time(now);
        break;
      }
      case 6: {
        const std::uint32_t entry = entries[28 + step.other % 8];
        const std::span<const std::uint8_t> bytes{step.data.data(), value_of(dynamic_node, entry).size()};
        const auto index = static_cast<std::uint16_t>(entry >> 8);
        const auto sub_index = static_cast<std::uint8_t>(entry);
        require(dynamic_node.set(index, sub_index, bytes) == static_node.set(index, sub_index, bytes),
                "both take the same");
        break;
      }
      default: dynamic_bus.room.room = static_bus.room.room = (step.choice & 3) == 0 ? step.number & 3u : 1000; break;
    }
    require(dynamic_bus.sent.size() <= 400, "what a node sends at once is bounded");
    require(dynamic_bus.sent == static_bus.sent, "both send the same frames");
    dynamic_bus.sent.clear();
    static_bus.sent.clear();
    check_limits(static_node);
    for (const std::uint32_t entry : entries)
      require(value_of(dynamic_node, entry) == value_of(static_node, entry), "both have the same values");
  }
  return 0;
}
