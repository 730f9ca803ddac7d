/// PDOs of four objects in eight bytes: one TPDO built, one RPDO processed, and a cycle of four RPDOs, a SYNC and four
/// TPDOs.
#include "../cortex_m/count.hpp"
#include "../cortex_m/startup.hpp"

#include <canopen/node.hpp>
#include <cstdint>
#include <cstring>
#include <device/device.hpp>

namespace {

struct Mailbox {
  volatile std::uint32_t id;
  volatile std::uint32_t words[2];
};
Mailbox mailbox;
std::uint32_t sent;

[[gnu::noinline]] bool transmit(const canopen::Frame& frame) {
  std::uint32_t words[2];
  std::memcpy(words, frame.data.data(), sizeof words);
  mailbox.id = frame.id;
  mailbox.words[0] = words[0];
  mailbox.words[1] = words[1];
  ++sent;
  return true;
}

struct Can {
  static bool send(const canopen::Frame& frame) { return transmit(frame); }
};
Can can;

constinit auto node = canopen::make_node<device::Device>(can);
constinit canopen::ObjectStore<device::Device> store;

canopen::Frame frame_of(std::uint32_t id, std::uint8_t size = 8) {
  canopen::Frame frame;
  frame.id = id;
  frame.size = size;
  for (std::uint8_t i = 0; i < size; ++i) frame.data[i] = static_cast<std::uint8_t>(id + i);
  return frame;
}

template <class Pdo, std::size_t... I>
void build(std::index_sequence<I...>) {
  canopen::Frame frame;
  Pdo::pack_into(frame, store.get<typename Pdo::template Entry<I>>()...);
  frame.id = 0x285;
  transmit(frame);
}

template <class Pdo, std::size_t... I>
[[gnu::noinline]] void take(const canopen::Frame& frame, std::index_sequence<I...>) {
  (store.set<typename Pdo::template Entry<I>>(Pdo::template get<I>(frame)), ...);
}

template <class Pdo>
constexpr auto positions = std::make_index_sequence<Pdo::entries>{};

}  // namespace

void program() {
  start_counter();
  print_mean("tpdo", [](std::uint32_t) { build<device::Tpdo2>(positions<device::Tpdo2>); });
  static canopen::Frame received = frame_of(0x305);
  print_mean("rpdo", [](std::uint32_t) { take<device::Rpdo2>(received, positions<device::Rpdo2>); });

  const canopen::TimePoint now{};
  node.start(canopen::NodeId{5}, now);
  static canopen::Frame frames[] = {frame_of(0x205), frame_of(0x305), frame_of(0x405), frame_of(0x505),
                                    frame_of(0x80, 0)};
  canopen::Frame start = frame_of(0, 2);
  start.data[0] = 1;
  start.data[1] = 5;
  node.on_frame(start, now);
  sent = 0;
  const auto cycle = [now](std::uint32_t) {
    for (const canopen::Frame& frame : frames) node.on_frame(frame, now);
  };
  cycle(0);
  if (sent == 4) print_mean("sync-cycle", cycle);
  end_program();
}
