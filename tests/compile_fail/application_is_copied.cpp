// expect: application: this would copy the variable into the node
// Changes of the copy would not be seen in the variable.
#include <canopen/host/memory_storage.hpp>
#include <canopen/node.hpp>
#include <every_service/device.hpp>
#include <utility>

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
  return canopen::make_node<
      Composition<every_service::Device, Application, without<lss, storage, od::file, od::stream>>>(
      bus, id, std::move(application));
#else
  return canopen::make_node<
      Composition<every_service::Device, Application, without<lss, storage, od::file, od::stream>>>(bus, id,
                                                                                                    application);
#endif
}
