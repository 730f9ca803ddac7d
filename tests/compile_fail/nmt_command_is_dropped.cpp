// expect: ignoring return value
// An NMT command is not sent if the bus has no room.
#include <canopen/nmt_master/nmt_master.hpp>

#ifdef __clang__
#pragma clang diagnostic error "-Wunused-result"
#endif

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

struct Host {
  void happened(canopen::NmtMasterEvent, canopen::NodeId, canopen::NmtState) {}
  void booted(canopen::NodeId, canopen::BootStatus) {}
  void network_started() {}
  void boot_time_elapsed() {}
};

bool stop(canopen::NmtMaster<Bus, 1, Host>& master) {
#ifdef GOOD
  return master.command(canopen::NmtCommand::stop, canopen::NodeId{});
#else
  master.command(canopen::NmtCommand::stop, canopen::NodeId{});
  return true;
#endif
}
