/// Arbitrary answers, at any time, on a bus with or without room: an LSS master sends only LSS requests, in their
/// order, waits no longer than specified, and ends each service.
///
/// An input is a sequence of steps of twelve bytes: an action, a choice, eight bytes of data, and two numbers.
#include <canopen/lss/lss_master.hpp>

#include <algorithm>
#include <cstring>

#include "fuzz.hpp"
#include "steps.hpp"

namespace edsc::fuzz {
namespace {

using canopen::Frame;
using canopen::LssAddress;
using canopen::LssOutcome;
using canopen::NodeId;
using canopen::TimePoint;

struct Bus : Room {
  std::uint8_t last = 0;  ///< command byte

  bool send(const Frame& frame) {
    require(frame.id == 0x7E5 && frame.size == 8 && !frame.extended && !frame.remote, "a master sends LSS requests");
    const std::uint8_t command = frame.data[0];
    constexpr std::uint8_t known[] = {0x04, 0x11, 0x13, 0x15, 0x17, 0x40, 0x41, 0x42, 0x43, 0x46, 0x47,
                                      0x48, 0x49, 0x4A, 0x4B, 0x4C, 0x51, 0x5A, 0x5B, 0x5C, 0x5D, 0x5E};
    require(std::find(std::begin(known), std::end(known), command) != std::end(known), "a request exists");
    if (command == 0x51) {
      require((frame.data[5] <= 31 || frame.data[5] == 0x80) && frame.data[6] <= 3 && frame.data[7] <= 3,
              "the numbers of Fastscan have their ranges");
    } else {
      const bool has_word = (command >= 0x40 && command <= 0x4B);
      for (std::size_t i = has_word ? 5 : 3; i < 8; ++i) require(frame.data[i] == 0, "reserved bytes are 0");
    }
    if (!take()) return false;
    const bool follows = (command > 0x40 && command <= 0x43) || (command > 0x46 && command <= 0x4B);
    require(!follows || last + 1 == command, "the frames of a sequence come in order");
    last = command;
    return true;
  }
};

constexpr std::uint8_t answers[] = {0x11, 0x13, 0x17, 0x44, 0x4F, 0x4F, 0x4F, 0x50, 0x5A, 0x5B, 0x5C, 0x5D, 0x5E};

using Master = canopen::LssMaster<Bus>;

bool begin(Master& master, const Step& step, TimePoint now) {
  LssAddress address{};
  std::memcpy(&address.vendor_id, step.data.data(), 4);
  std::memcpy(&address.serial_number, step.data.data() + 4, 4);
  switch (step.choice % 16) {
    case 0: return master.switch_state_global(static_cast<canopen::LssState>(step.number & 1), now);
    case 1: return master.switch_state_selective(address, now);
    case 2: return master.configure_node_id(NodeId{step.number}, now);
    case 3: return master.configure_bit_timing({step.number, step.other}, now);
    case 4: return master.activate_bit_timing(std::chrono::duration<std::uint16_t, std::milli>{step.number}, now);
    case 5: return master.store_configuration(now);
    case 6: return master.inquire_vendor_id(now);
    case 7: return master.inquire_product_code(now);
    case 8: return master.inquire_revision_number(now);
    case 9: return master.inquire_serial_number(now);
    case 10: return master.inquire_node_id(now);
    case 11: return master.identify_remote_slave({.vendor_id = address.vendor_id}, now);
    case 12: return master.identify_non_configured_remote_slave(now);
    case 13: return master.fastscan(now);
    default: return step.number % 6 <= 4 && master.fastscan(address, step.number % 6, now);
  }
}

}  // namespace
}  // namespace edsc::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace edsc::fuzz;
  Bus bus;
  Master master{bus};
  TimePoint now{};
  for (const Step& step : Steps{data, size}) {
    bus.sent = 0;
    switch (step.what % 8) {
      case 0:
      case 1: {
        const bool was_busy = master.busy();
        const bool begun = begin(master, step, now);
        require(!was_busy || !begun, "a master that is busy begins nothing");
        require(begun || bus.sent == 0, "what is not begun sends nothing");
        break;
      }
      case 2:
      case 3:
      case 4: {
        Frame frame{.id = 0x7E4, .size = 8};
        std::memcpy(frame.data.data(), step.data.data(), 8);
        if ((step.choice & 1) == 0) frame.data[0] = answers[step.other % std::size(answers)];
        if ((step.choice & 2) != 0) frame.size = step.number % 9;
        if ((step.choice & 12) == 12) frame.id = 0x7E5;
        frame.remote = (step.choice & 0x30) == 0x30;
        frame.extended = (step.choice & 0xC0) == 0xC0;
        master.on_frame(frame, now);
        require(bus.sent == 0, "an answer makes a master send nothing before its time");
        break;
      }
      case 5: now = now + canopen::Duration{step.number * 1000u}; [[fallthrough]];
      case 6:
        if (const auto deadline = master.next_deadline(); deadline && *deadline > now && (step.choice & 1) != 0)
          now = *deadline;
        master.on_time(now);
        if (bus.room > 500 && master.busy())
          require(*master.next_deadline() > now, "a master does not want to be called again at once");
        break;
      default: bus.room = (step.choice & 1) == 0 ? step.number % 8u : 1000; break;
    }
    require(bus.sent <= 6, "a service is six frames at most at once");
    require(master.busy() == master.next_deadline().has_value(), "a service that runs has a deadline");
  }
  bus.room = 1000;
  for (int steps = 0; master.busy(); ++steps) {
    require(steps < 150, "a service ends when nobody answers");
    if (*master.next_deadline() > now) now = *master.next_deadline();
    master.on_time(now);
  }
  require(master.outcome() == LssOutcome::done || master.outcome() == LssOutcome::refused ||
              master.outcome() == LssOutcome::no_answer,
          "a service ends in one of three ways");
  return 0;
}
