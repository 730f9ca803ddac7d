/// Arbitrary frames at any time, on a bus with or without room, between arbitrary calls of the application: a node with
/// every service stays inside its memory and allocates none, sends only what its NMT state allows, never needs to be
/// called again immediately, and works again after a reset.
///
/// An input is a sequence of steps of twelve bytes: an action, a choice, eight bytes of data, and two numbers.
#include <canopen/node.hpp>
#include <every_service/device.hpp>

#include <sanitizer/allocator_interface.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "support/omitting.hpp"

namespace {

namespace od = every_service::od;
using canopen::AbortCode;
using canopen::Frame;
using canopen::LssBitTiming;
using canopen::LssError;
using canopen::NmtState;
using canopen::NodeId;
using canopen::TimePoint;
using namespace std::chrono_literals;

void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %s\n", what);
  std::abort();
}

/// Counts allocations from the heap while the node runs, in its thread: libFuzzer has others.
thread_local bool running = false;
unsigned allocations = 0;

struct Device : every_service::Device {
  static constexpr canopen::DeviceOptions options = [] {
    canopen::DeviceOptions with_timeout = every_service::Device::options;
    with_timeout.sdo_timeout = 100;
    return with_timeout;
  }();
};

/// The answers of the application, and what it expects.
struct Application {
  AbortCode answer = canopen::ok;
  LssError lss_error{};
  std::uint32_t expected = 0;  ///< offset of the next piece of a streamed download
  bool off_bus = false;
};

struct Port {
  Application& application;
  [[nodiscard]] LssError accept(NodeId) const { return application.lss_error; }
  [[nodiscard]] LssError accept(LssBitTiming) const { return application.lss_error; }
  [[nodiscard]] LssError store(NodeId, LssBitTiming) const { return application.lss_error; }
  [[nodiscard]] static LssBitTiming bit_timing() { return {}; }
  void stop_communication() const {
    require(!application.off_bus, "a device leaves the bus once");
    application.off_bus = true;
  }
  void start_communication(LssBitTiming) const {
    require(application.off_bus, "a device that comes back has left");
    application.off_bus = false;
  }
};

struct Memory {
  std::array<std::uint8_t, 2048> image{};
  std::array<std::uint8_t, 2048> fresh{};
  std::uint32_t image_size = 0;
  std::uint32_t fresh_size = 0;
  std::uint32_t announced = 0;
  bool fails = false;

  [[nodiscard]] canopen::StorageState open() const {
    return image_size == 0 ? canopen::StorageState::empty : canopen::StorageState::whole;
  }
  [[nodiscard]] std::uint32_t size() const { return image_size; }
  [[nodiscard]] bool read(std::uint32_t position, std::span<std::uint8_t> to) const {
    require(position + to.size() <= image_size, "what is read has been stored");
    if (!to.empty()) std::memcpy(to.data(), &image[position], to.size());
    return !fails;
  }
  [[nodiscard]] bool begin(std::uint32_t size) {
    require(size <= fresh.size(), "an image is as large as the parameters");
    announced = size;
    fresh_size = 0;
    return !fails;
  }
  [[nodiscard]] bool write(std::span<const std::uint8_t> bytes) {
    require(fresh_size + bytes.size() <= announced, "no more is written than was announced");
    if (!bytes.empty()) std::memcpy(&fresh[fresh_size], bytes.data(), bytes.size());
    fresh_size += static_cast<std::uint32_t>(bytes.size());
    return true;
  }
  [[nodiscard]] bool commit() {
    require(fresh_size == announced, "as much is written as was announced");
    if (fails) return false;
    image = fresh;
    image_size = fresh_size;
    return true;
  }
};

struct CheckedBus {
  Application& application;
  unsigned room = 1000;
  unsigned sent = 0;                          ///< since the last step
  bool answered = false;                      ///< 1000h has been uploaded
  NmtState state = NmtState::initialisation;  ///< last one that the node has reported
  NodeId node_id{5};

  bool send(const Frame& frame) {
    require(!application.off_bus, "a device that switches its bit rate sends nothing");
    require(frame.size <= 8 && !frame.remote, "data frames have up to eight bytes");
    require(frame.id <= (frame.extended ? 0x1FFF'FFFFu : 0x7FFu), "a CAN-ID has its length");
    require(state != NmtState::stopped || is_error_control_or_lss(frame),
            "a stopped device has no communication objects");
    require(state != NmtState::initialisation || is_error_control_or_lss(frame),
            "nothing comes before the boot-up message");
    if (room == 0) return false;
    --room;
    ++sent;
    if (frame.id == 0x580u + node_id.value()) answered = answered || is_device_type(frame);
    return true;
  }

  [[nodiscard]] static bool is_error_control_or_lss(const Frame& frame) {
    return !frame.extended && ((frame.id > 0x700 && frame.id <= 0x77F && frame.size == 1) || frame.id == 0x7E4);
  }
  [[nodiscard]] static bool is_device_type(const Frame& frame) {
    return frame.size == 8 && frame.data == canopen::sdo::Data{0x43, 0x00, 0x10};
  }
};

/// DOMAINs are bound to memory of these sizes, a separate one each, so that writing outside it is detected.
constexpr std::size_t sizes[] = {0, 1, 20, 300};

struct Step {
  std::uint8_t what;
  std::uint8_t choice;
  canopen::sdo::Data data;
  std::uint8_t number;
  std::uint8_t other;
};

// CAN-IDs that node 5 receives, and one of each kind that it does not.
constexpr std::uint16_t can_ids[] = {0x000, 0x080, 0x081, 0x087, 0x100, 0x185, 0x205, 0x285, 0x305, 0x385, 0x405,
                                     0x485, 0x605, 0x605, 0x605, 0x6C0, 0x704, 0x705, 0x707, 0x7E5, 0x606, 0x707};

constexpr std::uint32_t entries[] = {
    0x100000, 0x100300, 0x100301, 0x100500, 0x100600, 0x100700, 0x100800, 0x100C00, 0x100D00, 0x101001, 0x101004,
    0x101101, 0x101200, 0x101300, 0x101400, 0x101500, 0x101601, 0x101602, 0x101700, 0x101900, 0x102001, 0x102807,
    0x102901, 0x120101, 0x120102, 0x140001, 0x140002, 0x140005, 0x140101, 0x140201, 0x160000, 0x160001, 0x160002,
    0x160108, 0x160200, 0x180001, 0x180002, 0x180003, 0x180005, 0x180006, 0x180102, 0x180201, 0x180303, 0x1A0000,
    0x1A0001, 0x1A0002, 0x1A0108, 0x1A0200, 0x1A0300, 0x1FA001, 0x1FA002, 0x1FD001, 0x200000, 0x200100, 0x200201,
    0x200300, 0x200400, 0x200500, 0x200600, 0x200700, 0x200800, 0x200901, 0x200A00, 0x200B00, 0x200C00, 0x200D00};

constexpr std::uint8_t nmt_commands[] = {1, 2, 128, 129, 130};
constexpr std::uint8_t lss_commands[] = {0x04, 0x11, 0x13, 0x15, 0x17, 0x40, 0x43, 0x46, 0x4B, 0x4C, 0x51, 0x5A, 0x5E};

void put_entry(Frame& frame, std::uint8_t choice) {
  const std::uint32_t entry = entries[choice % std::size(entries)];
  canopen::sdo::put_multiplexer(frame.data, static_cast<std::uint16_t>(entry >> 8), static_cast<std::uint8_t>(entry));
}

/// A frame with one of the CAN-IDs, mostly with a valid first byte or an existing entry.
[[nodiscard]] Frame frame_of(const Step& step) {
  Frame frame{.id = can_ids[step.choice % std::size(can_ids)], .size = 8, .data = step.data};
  if ((step.number & 0x80) != 0) frame.size = step.number & 7;
  frame.remote = (step.number & 0x60) == 0x60;
  if ((step.number & 0x18) == 0x18) std::memcpy(&frame.id, &step.data[4], sizeof frame.id);
  frame.extended = frame.id > 0x7FF;
  frame.id &= 0x1FFF'FFFF;
  if ((step.number & 4) != 0) return frame;
  if (frame.id == 0x605 || frame.id == 0x6C0) put_entry(frame, step.other);
  if (frame.id == 0x000) {
    frame.size = 2;
    frame.data[0] = nmt_commands[step.other % std::size(nmt_commands)];
    frame.data[1] = (step.number & 1) != 0 ? 5 : 0;
  }
  if (frame.id == 0x7E5) frame.data[0] = lss_commands[step.other % std::size(lss_commands)];
  return frame;
}

/// A download of one to four bytes.
[[nodiscard]] Frame download_of(const Step& step) {
  Frame frame{.id = 0x605, .size = 8, .data = step.data};
  frame.data[0] = static_cast<std::uint8_t>(0x23 | (step.number & 3) << 2);
  put_entry(frame, step.choice);
  return frame;
}

template <class Node>
class Run {
 public:
  Run(Node& node, CheckedBus& bus, Application& application, Memory& storage,
      std::array<std::vector<std::uint8_t>, std::size(sizes)>& memory)
      : node_{node}, bus_{bus}, application_{application}, storage_{storage}, memory_{memory} {}

  void step(const Step& step) {
    bus_.sent = 0;
    switch (step.what & 7) {
      case 0:
      case 1:
      case 2: node_.on_frame(frame_of(step), now_); break;
      case 3:
      case 4: node_.on_frame(download_of(step), now_); break;
      case 5: pass(step); break;
      case 6: call(step); break;
      case 7: bus_.room = (step.choice & 3) == 0 ? step.number & 3u : 1000; break;
    }
    require(bus_.sent <= 600, "what a node sends at once is bounded");
    require(allocations == 0, "a node takes nothing from the heap");
    check();
  }

  /// On a free bus the node works again after "reset node".
  void reset() {
    bus_.room = 100'000;
    for (int i = 0; i < 3; ++i) {
      now_ = now_ + canopen::Duration{66s};
      node_.on_time(now_);
    }
    require(!application_.off_bus, "the switch of a bit rate ends");
    node_.on_frame(Frame{.id = 0, .size = 2, .data = {0x81, node_.node_id().value()}}, now_);
    if (!node_.node_id().valid()) return;  // LSS has removed its node-ID
    require(node_.state() == NmtState::pre_operational, "a device is Pre-operational after a reset");
    bus_.node_id = node_.node_id();
    bus_.answered = false;
    node_.on_frame(Frame{.id = 0x600u + node_.node_id().value(), .size = 8, .data = {0x40, 0x00, 0x10}}, now_);
    require(bus_.answered, "1000h answers after a reset");
    check();
  }

 private:
  void pass(const Step& step) {
    switch (step.choice & 3) {
      case 0: now_ = now_ + canopen::Duration{step.number}; break;
      case 1: now_ = now_ + canopen::Duration{step.number * 1000u}; break;
      case 2: now_ = now_ + canopen::Duration{step.number * 7'000'000u}; break;
      case 3:
        for (unsigned i = 0; i <= (step.number & 7u); ++i) {
          const auto deadline = node_.next_deadline();
          if (!deadline) break;
          if (*deadline > now_) now_ = *deadline;
          node_.on_time(now_);
        }
        return;
    }
    node_.on_time(now_);
  }

  void call(const Step& step) {
    const std::uint8_t byte = step.data[0];
    const std::uint8_t number = step.number;
    switch (step.choice & 15) {
      case 0: (void)node_.template set<od::byte>(byte); break;
      case 1: (void)node_.template set<od::percentage>(byte); break;
      case 2: (void)node_.template set<od::positions<2>>(byte); break;
      case 3: {
        const std::uint32_t entry = entries[step.other % std::size(entries)];
        const std::span<const std::uint8_t> bytes{step.data.data(), number % 9u};
        (void)node_.set(static_cast<std::uint16_t>(entry >> 8), static_cast<std::uint8_t>(entry), bytes);
        break;
      }
      case 4: node_.emergency(byte, static_cast<canopen::ErrorRegister>(number)); break;
      case 5: node_.emergency_over(static_cast<canopen::ErrorRegister>(number)); break;
      case 6: node_.on_bus_status({static_cast<canopen::BusState>(number % 3), (number & 0x80) != 0}, now_); break;
      case 7: (void)node_.send_time({}); break;
      case 8: (void)node_.save(static_cast<std::uint8_t>(1 + number % 4)); break;
      case 9: (void)node_.restore(static_cast<std::uint8_t>(1 + number % 4)); break;
      case 10: (void)node_.send_mpdo({NodeId{static_cast<std::uint8_t>(number & 127)}, 0x2000, 0}, byte); break;
      case 11: bind(number); break;
      case 12: application_.answer = (number & 1) != 0 ? AbortCode::device_state : canopen::ok; break;
      case 13: application_.lss_error = {static_cast<std::uint8_t>(number & 1), 0}; break;
      case 14: storage_.fails = (number & 1) != 0; break;
      case 15: (void)node_.template set<od::contacts<1>>((byte & 1) != 0); break;
    }
  }

  void bind(std::uint8_t number) {
    std::vector<std::uint8_t>& memory = memory_[number % std::size(sizes)];
    node_.template bind<od::file>(memory, memory.size() / (1 + number / 128));
  }

  void check() {
    const canopen::Domain file = node_.template get<od::file>();
    require(file.size <= file.capacity, "a DOMAIN fits its memory");
    require(node_.template get<od::text>().size <= 16 && node_.template get<od::octets>().size <= 40,
            "a string fits its memory");
    if (bus_.room < 500) return;
    node_.on_time(now_);
    const auto deadline = node_.next_deadline();
    require(!deadline || *deadline > now_, "a node that has been called has nothing to do at once");
  }

  Node& node_;
  CheckedBus& bus_;
  Application& application_;
  Memory& storage_;
  std::array<std::vector<std::uint8_t>, std::size(sizes)>& memory_;
  TimePoint now_{};
};

[[nodiscard]] AbortCode write_stream(Application& application, std::uint32_t offset, std::size_t size, bool last) {
  require(offset == 0 || offset == application.expected, "a download comes in order");
  application.expected = last ? 0 : offset + static_cast<std::uint32_t>(size);
  return application.answer;
}

[[nodiscard]] canopen::Result<std::uint32_t> read_stream(const Application& application, std::uint32_t offset,
                                                         std::span<std::uint8_t> bytes) {
  constexpr std::uint32_t length = 2000;
  require(offset <= length, "an upload asks for what there is");
  if (application.answer != canopen::ok) return application.answer;
  const auto count = std::min(static_cast<std::uint32_t>(bytes.size()), length - offset);
  std::memset(bytes.data(), 0x5A, count);
  return count;
}

void run(const std::uint8_t* data, std::size_t size, std::array<std::vector<std::uint8_t>, std::size(sizes)>& memory) {
  Application application;
  Port port{application};
  Memory storage;
  CheckedBus bus{application};
  unsigned syncs = 0;
  auto node = bench::make_node<Device>(
      bus, NodeId{5}, canopen::stored_in(storage), canopen::configured_by_lss(port),
      canopen::on_write<od::percentage>([&](std::uint8_t) { return application.answer; }),
      canopen::on_write<od::command>([&](auto& self, std::uint32_t value) {
        (void)self.template set<od::word>(static_cast<std::uint16_t>(value));
      }),
      canopen::on_read<od::measured_value>([&] { return static_cast<std::int16_t>(++syncs); }),
      canopen::on_domain_read<od::stream>(
          [&](std::uint32_t offset, std::span<std::uint8_t> bytes) { return read_stream(application, offset, bytes); }),
      canopen::on_domain_write<od::stream>([&](std::uint32_t offset, std::span<const std::uint8_t> bytes, bool last) {
        return write_stream(application, offset, bytes.size(), last);
      }),
      canopen::on_state([&](NmtState state) { bus.state = state; }),
      canopen::on_sync([&](auto& self, std::uint8_t counter) {
        require(counter == 0 || canopen::to_raw(self.template get<od::synchronous_counter_overflow_value>()) != 0,
                "only a counted SYNC has a counter");
        (void)self.template set<od::measured_value>(static_cast<std::int16_t>(++syncs));
      }),
      canopen::on_time_of_day([](canopen::TimeOfDay time) { require(time.milliseconds <= 0x0FFF'FFFF, "28 bits"); }),
      canopen::on_heartbeat([](canopen::HeartbeatEvent, NodeId other, NmtState) { require(other.valid(), "1..127"); }),
      canopen::on_life_guarding([](auto& self, bool) { (void)self.template set<od::byte>(1); }),
      canopen::on_emergency([](canopen::ConsumedEmergency emergency) {
        require(emergency.sub_index >= 1 && emergency.sub_index <= 8, "1028h has eight entries");
      }),
      canopen::on_rpdo([](canopen::RpdoEvent, std::uint16_t number) { require(number >= 1 && number <= 3, "1..3"); }));
  node.start(TimePoint{});
  Run steps{node, bus, application, storage, memory};
  for (; size >= sizeof(Step); data += sizeof(Step), size -= sizeof(Step)) {
    Step step;
    std::memcpy(&step, data, sizeof step);
    steps.step(step);
  }
  steps.reset();
}

void on_malloc(const volatile void*, std::size_t) {
  if (running) ++allocations;
}
void on_free(const volatile void*) {}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  require(__sanitizer_install_malloc_and_free_hooks(on_malloc, on_free) != 0, "the heap can be watched");
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static_assert(sizeof(Step) == 12);
  std::array<std::vector<std::uint8_t>, std::size(sizes)> memory;
  for (std::size_t i = 0; i < memory.size(); ++i) memory[i].resize(sizes[i]);
  running = true;
  run(data, size, memory);
  running = false;
  return 0;
}
