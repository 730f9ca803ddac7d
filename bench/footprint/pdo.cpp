/// The codec of PDOs of four objects in eight bytes: one TPDO packed, one RPDO unpacked.
#include "../cortex_m/count.hpp"
#include "../cortex_m/startup.hpp"
#include "counted_bus.hpp"

#include <canopen/od/object_store.hpp>
#include <cstdint>
#include <device/device.hpp>
#include <utility>

namespace {

CountedBus bus;
constinit canopen::ObjectStore<device::Device> store;

template <class Pdo, std::size_t... I>
void build(std::index_sequence<I...>) {
  canopen::Frame frame;
  Pdo::pack_into(frame, store.get<typename Pdo::template Entry<I>>()...);
  frame.id = 0x285;
  static_cast<void>(bus.send(frame));
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
  static const canopen::Frame received = canopen::make_frame(0x305, 8, {0x0403'0201, 0x0807'0605});
  print_mean("rpdo", [](std::uint32_t) { take<device::Rpdo2>(received, positions<device::Rpdo2>); });
  end_program();
}
