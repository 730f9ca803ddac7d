/// Arbitrary answers to the typed access of a master: a RemoteNode sends SDO requests only to its node, sends no value
/// outside the limits of the EDS, and its values are valid for their types.
///
/// An input is a byte of settings and a sequence of steps of twelve bytes: an action, a choice, eight bytes of data,
/// and two numbers.
#include <canopen/sdo/remote_node.hpp>
#include <sample/device.hpp>

#include <cstring>
#include <vector>

#include "fuzz.hpp"
#include "steps.hpp"

namespace edsc::fuzz {
namespace {

namespace od = sample::od;
using canopen::AbortCode;
using canopen::Frame;
using canopen::TimePoint;

struct Bus : Room {
  bool send(const Frame& frame) {
    require(frame.id == 0x605 && frame.size == 8 && !frame.extended && !frame.remote, "requests go to the node");
    return take();
  }
};

using Remote = canopen::RemoteNode<sample::Device, Bus>;

/// Checks that a value of an object, if there is one, is valid for its type.
template <class O>
void look_at(Remote& remote) {
  const auto value = remote.value<O>();
  if (!value) return;
  if constexpr (std::is_same_v<typename O::type, bool>) {
    std::uint8_t byte = 0;
    std::memcpy(&byte, &*value, 1);
    require(byte <= 1, "a BOOLEAN is true or false");
  } else if constexpr (std::is_integral_v<typename O::type> && O::bits < 8 * sizeof(typename O::type)) {
    constexpr std::int64_t half = std::int64_t{1} << (O::bits - 1);
    const auto number = static_cast<std::int64_t>(*value);
    if constexpr (std::is_signed_v<typename O::type>) {
      require(number >= -half && number < half, "a number of 24 or 40 bits has its sign");
    } else {
      require(number >= 0 && number < 2 * half, "a number of 24 or 40 bits is below its end");
    }
  }
}

/// Begins to write the value of the input; a value outside the limits is not sent.
template <class O>
void write(Remote& remote, Bus& bus, const Step& step, TimePoint now) {
  typename O::type value{};
  if constexpr (std::is_same_v<typename O::type, bool>) {
    value = (step.data[0] & 1) != 0;
  } else {
    std::memcpy(&value, step.data.data(), sizeof value);
  }
  const bool was_busy = remote.busy();
  const unsigned before = bus.sent;
  const auto begun = remote.write<O>(value, now);
  const bool right = canopen::check_value<O>(value) == canopen::ok;
  require(static_cast<bool>(begun) == (right && !was_busy), "a value inside its limits is sent");
  require(begun || bus.sent == before, "what is refused sends nothing");
}

template <class O>
void read(Remote& remote, const Step&, TimePoint now) {
  const bool was_busy = remote.busy();
  require(static_cast<bool>(remote.read<O>(now)) == !was_busy, "a node that is not busy is read");
}

void begin(Remote& remote, Bus& bus, const Step& step, TimePoint now, std::vector<std::uint8_t>& memory) {
  constexpr unsigned text = 16;
  // A refused write keeps the result of the transfer before, and the memory that it has used.
  if (!remote.busy() && step.choice % 20 == text) memory = std::vector<std::uint8_t>(step.other);
  switch (step.choice % 20) {
    case 0: return read<od::boolean_value>(remote, step, now);
    case 1: return read<od::integer8_value>(remote, step, now);
    case 2: return read<od::integer16_value>(remote, step, now);
    case 3: return read<od::integer24_value>(remote, step, now);
    case 4: return read<od::unsigned24_value>(remote, step, now);
    case 5: return read<od::integer40_value>(remote, step, now);
    case 6: return read<od::unsigned64_value>(remote, step, now);
    case 7: return read<od::device_type>(remote, step, now);
    case 8: return read<od::unsigned40_value>(remote, step, now);
    case 9: return write<od::boolean_value>(remote, bus, step, now);
    case 10: return write<od::integer8_value>(remote, bus, step, now);
    case 11: return write<od::integer16_value>(remote, bus, step, now);
    case 12: return write<od::integer24_value>(remote, bus, step, now);
    case 13: return write<od::unsigned24_value>(remote, bus, step, now);
    case 14: return write<od::integer64_value>(remote, bus, step, now);
    case 15: return write<od::unsigned40_value>(remote, bus, step, now);
    case text: (void)remote.read<od::manufacturer_device_name>(memory, now); return;
    case 17: return read<od::error_register>(remote, step, now);
    case 18: return write<od::producer_heartbeat_time>(remote, bus, step, now);
    default: return read<od::producer_heartbeat_time>(remote, step, now);
  }
}

constexpr std::uint16_t indices[] = {0x2000, 0x2001, 0x2002, 0x2003, 0x2004, 0x2006, 0x2008, 0x1000, 0x2009, 0x2000,
                                     0x2001, 0x2002, 0x2003, 0x2004, 0x2007, 0x2009, 0x1008, 0x1001, 0x1017, 0x1017};

}  // namespace
}  // namespace edsc::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace edsc::fuzz;
  if (size == 0) return 0;
  Bus bus;
  Remote remote{bus, canopen::NodeId{5},
                canopen::SdoClientOptions{.timeout = std::chrono::milliseconds{10},
                                          .block_transfer = (data[0] & 1) != 0,
                                          .block_threshold = 10,
                                          .block_size = static_cast<std::uint8_t>((data[0] >> 1) + 1)}};
  ++data, --size;
  TimePoint now{};
  std::vector<std::uint8_t> memory;
  std::uint8_t entry = 0;
  for (const Step& step : Steps{data, size}) {
    bus.sent = 0;
    switch (step.what % 8) {
      case 0:
      case 1:
        if (!remote.busy()) entry = step.choice % 20;
        begin(remote, bus, step, now, memory);
        break;
      case 2:
      case 3:
      case 4:
      case 5: {
        Frame frame{.id = 0x585, .size = 8};
        std::memcpy(frame.data.data(), step.data.data(), 8);
        constexpr std::uint8_t commands[] = {0x43, 0x47, 0x4B, 0x4F, 0x42, 0x41, 0x40, 0x60, 0x80, 0xC6, 0xC1, 0xA2};
        if ((step.choice & 1) == 0) frame.data[0] = commands[step.other % std::size(commands)];
        if ((step.choice & 2) == 0) canopen::sdo::put_multiplexer(frame.data, indices[entry], 0);
        if ((step.choice & 0x0C) == 0x0C) frame.size = step.number % 9;
        if ((step.choice & 0x70) == 0x70) frame.id = 0x580u + step.number % 8u;
        remote.on_frame(frame, now);
        break;
      }
      case 6:
        now = now + canopen::Duration{step.number * 100u};
        remote.on_time(now);
        break;
      default: bus.room = (step.choice & 1) == 0 ? step.number % 8u : 1000; break;
    }
    require(bus.sent <= 128, "an answer brings a sub-block of requests at most");
    require(remote.data().size() <= memory.size() || remote.data().size() <= 8, "what is read has its room");
    look_at<od::boolean_value>(remote);
    look_at<od::integer24_value>(remote);
    look_at<od::unsigned24_value>(remote);
    look_at<od::integer40_value>(remote);
    look_at<od::unsigned40_value>(remote);
    look_at<od::integer8_value>(remote);
  }
  bus.room = 1000;
  for (int steps = 0; remote.busy(); ++steps) {
    require(steps < 10, "a transfer ends when its server is silent");
    const auto deadline = remote.next_deadline();
    require(deadline.has_value(), "a transfer that runs has a deadline");
    if (*deadline > now) now = *deadline;
    remote.on_time(now);
  }
  return 0;
}
