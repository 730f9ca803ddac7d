/// What a device or its master consists of, for the call graph of docs/safety.md: a node of every service with a
/// storage in steps, LSS and DOMAINs, a drive, and a master. With CALLS_NODE the application calls the node that calls
/// it.
#include <canopen/nmt_master/nmt_master.hpp>
#include <canopen/node.hpp>
#include <canopen/storage/background_storage.hpp>
#include <canopen/storage/flash_storage.hpp>
#include <every_service/device.hpp>

#include "../../examples/servo/motor.hpp"

namespace od = every_service::od;

struct Bus {
  bool send(const canopen::Frame& frame);
  canopen::Frame receive();
};

struct Pages {
  static constexpr std::uint32_t page_size = 2048;
  static constexpr std::uint32_t word_size = 8;
  bool erase(std::uint8_t page);
  bool ready();
  bool write(std::uint8_t page, std::uint32_t offset, std::span<const std::uint8_t> words);
  bool read(std::uint8_t page, std::uint32_t offset, std::span<std::uint8_t> to);
};

struct LssPort {
  canopen::LssError accept(canopen::NodeId);
  canopen::LssError accept(canopen::LssBitTiming);
  canopen::LssError store(canopen::NodeId, canopen::LssBitTiming);
  canopen::LssBitTiming bit_timing();
  void stop_communication();
  void start_communication(canopen::LssBitTiming);
};

#ifdef CALLS_NODE
struct Application {
  void written(od::byte, std::uint8_t value, auto& node) {
    node.request(canopen::NmtCommand::stop, node.now());
    node.set(od::word{}, value);
  }
  void on_state(canopen::NmtState, auto& node) {
    node.request(canopen::NmtCommand::start, node.now());
    node.emergency(0x1000, {});
  }
  void on_sync(std::uint8_t counter, auto& node) { node.set(od::word{}, counter); }
  void on_error(std::uint16_t, auto& node) { node.request(canopen::NmtCommand::stop, node.now()); }
  void on_rpdo(canopen::RpdoEvent, std::uint16_t, auto& node) { node.set(od::word{}, 1); }
  void every(canopen::Milliseconds<10>, auto& node) { node.request(canopen::NmtCommand::start, node.now()); }
};
#else
struct Application {
  void written(od::byte, std::uint8_t value) { last = value; }
  void on_state(canopen::NmtState) {}
  void on_sync(std::uint8_t) {}
  void on_error(std::uint16_t) {}
  void on_rpdo(canopen::RpdoEvent, std::uint16_t) {}
  void every(canopen::Milliseconds<10>) {}
  std::uint8_t last = 0;
};
#endif

struct MasterHost {
  void happened(canopen::NmtMasterEvent, canopen::NodeId, canopen::NmtState) {}
  void configure(canopen::NodeId) {}
  void booted(canopen::NodeId, canopen::BootResult) {}
  void network_started() {}
  void boot_time_elapsed() {}
};

canopen::TimePoint now();

void program(Bus& bus, Pages& pages, LssPort& port, std::span<const canopen::NmtSlave> slaves) {
  using Flash = canopen::FlashStorage<Pages>;
  using Storage = canopen::BackgroundStorage<Flash, 1024>;
  Flash flash{pages};
  Storage storage{flash};
  canopen::Node<every_service::Device, Bus, Application, canopen::BoundTo<od::file>, canopen::BoundTo<od::stream>,
                canopen::StoredIn<Storage>, canopen::ConfiguredByLss<LssPort>>
      node{bus, canopen::stored_in(storage), canopen::configured_by_lss(port)};
  canopen::cia402::DriveNode<ServoParts, Bus, Motor> drive{bus, canopen::NodeId{6}};
  canopen::NmtMaster<Bus, 4, MasterHost> master{bus, slaves, {}, canopen::from_milliseconds(100), {}};
  node.start(canopen::NodeId{5}, now());
  drive.start(now());
  master.start(now());
  for (;;) {
    const canopen::Frame frame = bus.receive();
    node.on_frame(frame, now());
    node.on_bus_status({}, now());
    node.request(canopen::NmtCommand::reset_node, now());
    static_cast<void>(node.save());
    static_cast<void>(node.map<3, canopen::Tpdo<od::byte>>());
    node.emergency(0x1000, {});
    node.on_time(now());
    drive.on_frame(frame, now());
    drive.fault(0x2310, canopen::ErrorRegister::current, now());
    drive.on_time(now());
    master.on_frame(frame, now());
    master.on_time(now());
    static_cast<void>(master.request(canopen::NodeId{7}, {}, now()));
  }
}
