/// Arbitrary characters on a serial line: an SLCAN adapter and a host decode only well-formed frames, respect the state
/// of the channel, and understand the next line.
///
/// An input is what the host or the adapter sends: the first byte selects which one, and how time passes.
#include <canopen/host/slcan_host.hpp>
#include <canopen/port/slcan_adapter.hpp>
#include <canopen/port/slcan_codec.hpp>
#include <span>
#include <string_view>

#include "fuzz.hpp"

namespace edsc::fuzz {
namespace {

using canopen::Frame;
using canopen::SlcanHost;
using canopen::TimePoint;

void check(const Frame& frame) {
  require(frame.size <= 8, "a frame has eight bytes at most");
  require(frame.id <= (frame.extended ? 0x1FFF'FFFFu : 0x7FFu), "identifiers have 11 or 29 bits");
  std::array<char, canopen::slcan::longest_line> line;
  const std::size_t size = canopen::slcan::encode(frame, line);
  require(line[size - 1] == canopen::slcan::end, "a line has an end");
  const auto again = canopen::slcan::decode({line.data(), size - 1});
  require(again && *again == frame, "a frame is the same when it is written and read");
}

struct Port {
  canopen::SlcanAdapter adapter;
  bool on_bus = false;
  std::size_t sent = 0;

  void write(std::span<const char> text) {
    require(!text.empty(), "an empty text is not an answer");
    const char last = text.back();
    require(last == canopen::slcan::end || last == canopen::slcan::refusal, "an answer has an end");
  }
  bool open(const canopen::SlcanChannel& channel) {
    require(!on_bus, "a channel is opened once");
    if (channel.rate == canopen::SlcanChannel::Rate::code) require(channel.value <= 8, "a bit rate is one of the nine");
    on_bus = channel.value != 3;
    return on_bus;
  }
  void close() {
    require(on_bus, "a channel that is closed was open");
    on_bus = false;
  }
  bool send(const Frame& frame) {
    require(on_bus, "frames are sent on an open channel");
    check(frame);
    return ++sent % 5 != 0;
  }
  std::uint8_t status() { return static_cast<std::uint8_t>(sent); }

  void take(std::string_view text) {
    for (const char character : text) {
      adapter.on_character(character, *this);
      require(adapter.is_open() == on_bus, "the adapter knows whether its channel is open");
    }
  }
};

void fuzz_adapter(std::string_view text) {
  Port port;
  port.take(text);
  port.adapter.on_frame({.id = 0x705, .size = 1}, TimePoint{}, port);
  port.take("\r");
  if (!port.on_bus) port.take("S4\rO\r");
  if (!port.on_bus) return;
  port.take("C\rS6\rO\r");
  const std::size_t before = port.sent;
  port.take("t1232AABB\r");
  require(port.sent == before + 1, "the next line is understood");
}

void fuzz_host(std::string_view text, unsigned char step) {
  SlcanHost host;
  TimePoint now{};
  host.start(step & 1 ? std::optional<std::uint8_t>{6} : std::nullopt, now);
  for (const char character : text) {
    now = now + canopen::Duration{step * 100u};
    if (const auto frame = host.on_character(character, now)) {
      require(host.state() == SlcanHost::State::open, "frames come from an open channel");
      check(*frame);
    }
    host.on_time(now);
    require(host.output().size() <= 16, "what is to be written is short");
    host.output_taken();
  }
  if (host.state() != SlcanHost::State::open) return;
  (void)host.on_character(canopen::slcan::end, now);
  std::optional<Frame> last;
  for (const char character : std::string_view{"t1232AABB\r"}) last = host.on_character(character, now);
  require(last && last->id == 0x123 && last->data[1] == 0xBB, "the next line is understood");
}

}  // namespace
}  // namespace edsc::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace edsc::fuzz;
  if (size == 0) return 0;
  const std::string_view text{reinterpret_cast<const char*>(data + 1), size - 1};
  data[0] % 2 == 0 ? fuzz_adapter(text) : fuzz_host(text, data[0]);
  return 0;
}
