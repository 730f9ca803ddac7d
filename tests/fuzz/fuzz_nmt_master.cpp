/// Arbitrary frames at any time, late, wrong or hostile ones, on a bus with or without room: an NMT master sends only
/// what a master may send, and only to its own slaves; its state of a node is the one that it has reported; it never
/// needs to be called again immediately.
///
/// An input is a configuration of five bytes and a sequence of steps of twelve: an action, a choice, eight bytes of
/// data, and two numbers.
#include <canopen/nmt_master/nmt_master.hpp>

#include <cstring>
#include <map>
#include <optional>
#include <vector>

#include "fuzz.hpp"
#include "steps.hpp"

namespace edsc::fuzz {
namespace {

using canopen::BootStatus;
using canopen::Frame;
using canopen::NmtCommand;
using canopen::NmtMasterEvent;
using canopen::NmtSlave;
using canopen::NmtState;
using canopen::NodeId;
using canopen::TimePoint;
using namespace std::chrono_literals;

constexpr std::size_t slave_count = 4;  // node-IDs 1 to 4; 3 is in the list but is not a slave

struct World : Room {
  std::array<NmtSlave, slave_count> slaves{};
  NodeId commanded{};  ///< by the application, in this step
  bool by_application = false;
  std::map<std::uint8_t, NmtState> told{};
  std::map<std::uint8_t, BootStatus> status{};
  std::array<bool, 128> boot_up{};
  bool network_started = false;
  bool restarts = false;  ///< 1F80h: the loss of a mandatory slave resets all nodes

  [[nodiscard]] bool is_slave(unsigned node_id) const {
    return node_id >= 1 && node_id <= slave_count && slaves[node_id - 1].has(canopen::slave_assignment::listed);
  }
};

struct Bus {
  World& world;
  bool send(const Frame& frame) {
    require(!frame.extended && frame.size <= 8, "a master sends base frames");
    if (frame.id == 0) {
      require(!frame.remote && frame.size == 2, "an NMT command has two bytes");
      const unsigned command = frame.data[0];
      require(command == 1 || command == 2 || (command >= 128 && command <= 130), "an NMT command is one of five");
      const unsigned to = frame.data[1];
      require(to == 0 || world.is_slave(to) || (world.by_application && to == world.commanded.value()),
              "an NMT command is for all nodes or for a slave");
    } else if ((frame.id & 0x780) == 0x700) {
      require(frame.remote, "an error control message of a master is a guarding request");
      const unsigned node_id = frame.id & 0x7F;
      require(world.is_slave(node_id), "a slave is guarded");
      const NmtSlave& slave = world.slaves[node_id - 1];
      require(slave.heartbeat_time == 0, "who has a heartbeat is not guarded");
      require(slave.guard_time() != 0 || slave.has(canopen::slave_assignment::keep_alive),
              "who is not guarded is asked only whether it runs already");
    } else {
      require((frame.id & 0x780) == 0x600 && !frame.remote && frame.size == 8, "all else are SDO requests");
      require(world.is_slave(frame.id & 0x7F), "a slave is identified");
      const unsigned specifier = frame.data[0] >> 5;
      const NmtSlave& slave = world.slaves[(frame.id & 0x7F) - 1];
      const unsigned index = frame.data[1] | frame.data[2] << 8;
      const bool heartbeat_time = index == 0x1017 && frame.data[3] == 0;
      const bool restores = index == 0x1011 && frame.data[3] == 1 && std::memcmp(&frame.data[4], "load", 4) == 0;
      require(specifier == 2 || specifier == 3 || specifier == 4 || (specifier == 1 && (heartbeat_time || restores)),
              "a master that boots a slave reads, and writes 1017h and 1011h");
      require(specifier != 1 || !heartbeat_time || slave.heartbeat_time != 0, "who is guarded has no heartbeat");
      require(specifier != 1 || !restores || slave.has(canopen::slave_assignment::restore), "its values are restored");
    }
    return world.take();
  }
};

struct Host {
  World& world;
  void happened(NmtMasterEvent event, NodeId node_id, NmtState state) {
    require(node_id.value() >= 1 && node_id.value() <= 127, "an event is of a node");
    require(event == NmtMasterEvent::boot_up || world.is_slave(node_id.value()), "slaves are watched");
    if (event == NmtMasterEvent::boot_up) {
      require(state == NmtState::initialisation, "a boot-up message tells Initialisation");
      world.told.erase(node_id.value());
    } else {
      require(state == NmtState::initialisation || state == NmtState::stopped || state == NmtState::operational ||
                  state == NmtState::pre_operational,
              "a state is one of four");
      world.told[node_id.value()] = state;
      if (event == NmtMasterEvent::lost) {
        world.told.erase(node_id.value());
        if (world.restarts && world.slaves[node_id.value() - 1U].has(canopen::slave_assignment::mandatory)) {
          world.network_started = false;
        }
      }
    }
  }
  void booted(NodeId node_id, BootStatus status) {
    if (!world.is_slave(node_id.value())) {
      require(status == BootStatus::not_listed, "slaves are booted");
      return;
    }
    require(status != BootStatus::not_listed, "a slave is listed");
    require(status != BootStatus::no_heartbeat || world.slaves[node_id.value() - 1u].heartbeat_time != 0,
            "no heartbeat to miss");
    world.status[node_id.value()] = status;
  }
  void network_started() {
    require(!world.network_started, "a network is started once, unless all nodes are reset");
    world.network_started = true;
    for (const NmtSlave& slave : world.slaves) {
      if (!slave.has(canopen::slave_assignment::listed) || !slave.has(canopen::slave_assignment::mandatory)) continue;
      const auto status = world.status.find(slave.node_id.value());
      require(status != world.status.end() &&
                  (status->second == BootStatus::booted || status->second == BootStatus::was_operational),
              "all mandatory slaves have booted");
    }
  }
  void boot_time_elapsed() const { require(!world.network_started, "somebody is missing when the time is over"); }
};

constexpr NmtCommand commands[] = {NmtCommand::start, NmtCommand::stop, NmtCommand::enter_pre_operational,
                                   NmtCommand::reset_node, NmtCommand::reset_communication};
constexpr std::uint32_t asked[] = {0x100000, 0x101801, 0x101802, 0x101803, 0x101804,
                                   0x101700, 0x1F5601, 0x102001, 0x102002, 0x101101};
constexpr std::uint8_t states[] = {0, 4, 5, 127, 0x80, 0x84, 0x85, 0xFF, 1, 3};

/// Mostly a matching answer or message.
Frame frame_of(const Step& step) {
  Frame frame{.size = 8};
  std::memcpy(frame.data.data(), step.data.data(), 8);
  const std::uint8_t node_id = static_cast<std::uint8_t>(1 + step.number % 5);
  switch (step.choice % 8) {
    case 0:
    case 1:
    case 2:
      frame.id = 0x580u + node_id;
      if ((step.choice & 8) == 0) {
        const std::uint32_t entry = asked[step.other % std::size(asked)];
        frame.data[0] = (step.choice & 0x10) != 0 ? (step.other & 0x40) != 0 ? 0x60 : 0x80
                                                  : static_cast<std::uint8_t>(0x43 | (step.choice >> 3 & 0xC));
        frame.data[1] = static_cast<std::uint8_t>(entry >> 8);
        frame.data[2] = static_cast<std::uint8_t>(entry >> 16);
        frame.data[3] = static_cast<std::uint8_t>(entry);
        // The expected identity is 1, 2, 3 and so on.
        if ((step.choice & 0x20) == 0) frame.data[4] = static_cast<std::uint8_t>(step.other % std::size(asked) + 1);
        if ((step.choice & 0x20) == 0) frame.data[5] = frame.data[6] = frame.data[7] = 0;
      }
      break;
    case 3:
    case 4:
    case 5:
    case 6:
      frame.id = 0x700u + node_id;
      frame.size = 1;
      frame.data[0] = states[step.other % std::size(states)];
      break;
    default:
      std::memcpy(&frame.id, &step.data[4], sizeof frame.id);
      frame.size = step.other % 9;
      frame.remote = (step.number & 0x80) != 0;
      frame.extended = (step.number & 0x40) != 0;
      frame.id &= frame.extended ? 0x1FFF'FFFF : 0x7FF;
      break;
  }
  return frame;
}

class Run {
 public:
  explicit Run(const std::uint8_t* settings) {
    for (std::uint8_t i = 0; i < slave_count; ++i) {
      NmtSlave& slave = world.slaves[i];
      const std::uint8_t bits = settings[1 + i];
      slave.node_id = NodeId{static_cast<std::uint8_t>(i + 1)};
      slave.assignment = i == 2 ? 0 : 1;
      if ((bits & 1) != 0) slave.assignment |= canopen::slave_assignment::boot;
      if ((bits & 2) != 0) slave.assignment |= canopen::slave_assignment::mandatory;
      if ((bits & 4) != 0) slave.assignment |= canopen::slave_assignment::keep_alive;
      if ((bits & 8) != 0) slave.assignment |= 50u << 16 | static_cast<std::uint32_t>(bits >> 6) << 8;
      if ((bits & 16) != 0) slave.heartbeat_time = 100;
      if ((bits & 32) != 0) slave.device_type = 1, slave.vendor_id = 2, slave.product_code = 3, slave.serial_number = 5;
      if ((bits & 64) != 0) slave.assignment |= canopen::slave_assignment::software_version, slave.software = 7;
      if ((bits & 128) != 0) {
        slave.configuration_date = 8, slave.configuration_time = 9, slave.restored_parameters = 1;
        slave.assignment |= canopen::slave_assignment::restore;
      }
    }
    start_up.bits = static_cast<std::uint32_t>(settings[0] & 0x7F);
    world.restarts = start_up.has(canopen::nmt_start_up::reset_all);
    if ((settings[0] & 0x80) != 0) start_up.boot_time = canopen::Duration{3s};
  }

  void steps(const std::uint8_t* data, std::size_t size) {
    canopen::NmtMaster<Bus, slave_count, Host> master{bus, world.slaves, start_up, canopen::Duration{100ms},
                                                      Host{world}};
    for (const Step& step : Steps{data, size}) {
      one(master, step);
      check(master);
    }
    world.room = 1'000'000;
    for (int i = 0; i < 30; ++i) pass(master);
  }

 private:
  template <class Master>
  void one(Master& master, const Step& step) {
    world.sent = 0;
    world.by_application = false;
    switch (step.what % 8) {
      case 0:
      case 1:
      case 2:
      case 3: {
        const Frame frame = frame_of(step);
        if ((frame.id & 0x780) == 0x700 && (frame.id & 0x7F) != 0 && !frame.extended && !frame.remote &&
            frame.size == 1 && frame.data[0] == 0)
          world.boot_up[frame.id & 0x7F] = true;
        master.on_frame(frame, now);
        break;
      }
      case 4: pass(master); break;
      case 5:
        now = now + canopen::Duration{step.number * 10'000u};
        master.on_time(now);
        break;
      case 6:
        switch (step.choice % 4) {
          case 0:
            world.network_started = false;
            master.start(now);
            break;
          case 1: master.boot(NodeId{step.number}, now); break;
          default:
            world.by_application = true;
            world.commanded = NodeId{step.number};
            (void)master.command(commands[step.other % std::size(commands)], world.commanded);
            break;
        }
        break;
      default: world.room = (step.choice & 3) == 0 ? step.number % 3u : 1000; break;
    }
    require(world.sent <= 60, "what a master sends at once is bounded");
  }

  /// Lets time pass to the next deadline.
  template <class Master>
  void pass(Master& master) {
    const auto deadline = master.next_deadline();
    if (!deadline) return;
    if (*deadline > now) now = *deadline;
    master.on_time(now);
    if (world.room < 500) return;
    const auto next = master.next_deadline();
    require(!next || *next > now, "a master that has been called does not want to be called again at once");
  }

  template <class Master>
  void check(const Master& master) {
    for (std::uint8_t node_id = 1; node_id <= slave_count + 1; ++node_id) {
      require(master.has_booted(NodeId{node_id}) == world.boot_up[node_id], "who has sent a boot-up message is known");
      const auto state = master.state(NodeId{node_id});
      if (!world.is_slave(node_id)) {
        require(!state && !master.status(NodeId{node_id}), "of other nodes nothing is kept");
        continue;
      }
      const auto told = world.told.find(node_id);
      if (state && *state != NmtState::initialisation)
        require(told != world.told.end() && told->second == *state, "the state of a node is the one that was told");
      const auto status = world.status.find(node_id);
      if (master.status(NodeId{node_id}))
        require(status != world.status.end() && status->second == *master.status(NodeId{node_id}),
                "a status has been told");
    }
  }

  World world;
  Bus bus{world};
  canopen::NmtStartUp start_up{};
  TimePoint now{};
};

}  // namespace
}  // namespace edsc::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 5) return 0;
  edsc::fuzz::Run{data}.steps(data + 5, size - 5);
  return 0;
}
