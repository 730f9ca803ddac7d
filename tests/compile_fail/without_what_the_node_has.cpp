// expect: without: the node has the part that its composition omits
// The composition omits the storage that the node gets.
#include <canopen/host/memory_storage.hpp>
#include <canopen/node.hpp>
#include <every_service/device.hpp>

namespace od = every_service::od;

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};
struct Port {
  canopen::LssError accept(canopen::NodeId) { return canopen::lss::success; }
  canopen::LssError accept(canopen::LssBitTiming) { return canopen::lss::success; }
  canopen::LssError store(canopen::NodeId, canopen::LssBitTiming) { return canopen::lss::success; }
  canopen::LssBitTiming bit_timing() { return {}; }
  void stop_communication() {}
  void start_communication(canopen::LssBitTiming) {}
};
struct Application {
  void on_state(canopen::NmtState) {}
};
using canopen::Composition, canopen::without, canopen::part::lss, canopen::part::storage;

auto make(Bus& bus, [[maybe_unused]] Port& port, [[maybe_unused]] canopen::MemoryStorage& memory,
          [[maybe_unused]] Application& application) {
  const canopen::NodeId id{5};
#ifdef GOOD
  return canopen::make_node<Composition<every_service::Device, without<lss, od::file, od::stream>>>(
      bus, id, canopen::stored_in(memory));
#else
  return canopen::make_node<Composition<every_service::Device, without<lss, storage, od::file, od::stream>>>(
      bus, id, canopen::stored_in(memory));
#endif
}
