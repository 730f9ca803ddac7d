/// Arbitrary answers, at any time, on a bus with or without room: an SDO client stays inside the caller's memory,
/// passes pieces in order, and ends when its server is silent.
///
/// An input is a sequence of steps of nine bytes: a control byte and an answer. Bits 0..2 of the control byte select
/// the action, bits 3..5 the number of frames that the bus accepts; bit 6 puts the client's entry into the answer.
#include <canopen/sdo/sdo_client.hpp>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <vector>

namespace {

using canopen::AbortCode;
using canopen::Duration;
using canopen::TimePoint;

void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %s\n", what);
  std::abort();
}

struct Bus {
  unsigned room = 0;
  bool send(const canopen::Frame& frame) {
    require(frame.id == 0x605 && frame.size == 8, "a request is a frame of eight bytes");
    if (room == 0) return false;
    --room;
    return true;
  }
};

constexpr std::uint32_t source_bytes = 1500;

struct Pieces {
  std::uint32_t taken = 0;
  AbortCode operator()(std::uint32_t offset, std::span<const std::uint8_t> bytes, bool /*last*/) {
    require(offset == taken, "an upload comes in order");
    taken += static_cast<std::uint32_t>(bytes.size());
    return taken > 100'000 ? AbortCode::out_of_memory : canopen::ok;
  }
};

canopen::Result<std::uint32_t> give(std::uint32_t offset, std::span<std::uint8_t> bytes) {
  require(offset <= source_bytes && bytes.size() <= 7, "a download asks for what there is");
  const auto count = std::min(static_cast<std::uint32_t>(bytes.size()), source_bytes - offset);
  std::memset(bytes.data(), 0x5A, count);
  return count;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::size_t step = 9;
  if (size == 0) return 0;
  const std::uint8_t settings = *data++;
  --size;
  Bus bus;
  canopen::SdoClient client{bus, canopen::NodeId{5},
                            canopen::SdoClientOptions{.timeout = std::chrono::milliseconds{10},
                                                      .block_transfer = (settings & 1) != 0,
                                                      .block_threshold = 10,
                                                      .block_size = static_cast<std::uint8_t>((settings >> 2) + 1),
                                                      .crc = (settings & 2) != 0}};
  TimePoint now{};
  std::vector<std::uint8_t> memory;
  Pieces pieces;
  auto source = [](std::uint32_t offset, std::span<std::uint8_t> bytes) { return give(offset, bytes); };
  for (; size >= step; data += step, size -= step) {
    const std::uint8_t control = data[0];
    canopen::Frame frame{.id = 0x585, .size = 8};
    std::memcpy(frame.data.data(), data + 1, 8);
    bus.room = (control >> 3 & 7) == 7 ? 200u : control >> 3 & 7u;
    if ((control & 0x40) != 0) canopen::sdo::put_multiplexer(frame.data, 0x2012, 0);
    if (!client.busy() && (control & 7) < 4) {
      pieces = {};
      memory = std::vector<std::uint8_t>(frame.data[7]);
      switch (control & 3) {
        case 0: client.upload(0x2012, 0, memory, now); break;
        case 1: client.download(0x2012, 0, memory, now); break;
        case 2: client.upload(0x2012, 0, canopen::sink_of(pieces), now); break;
        case 3:
          client.download(0x2012, 0, canopen::source_of(source, frame.data[6] % 2 != 0 ? source_bytes : 0xFFFF'FFFF),
                          now);
          break;
      }
    } else if ((control & 7) == 6) {
      now = now + Duration{frame.data[0] * 100u};
      client.on_time(now);
    } else if ((control & 7) == 7 && frame.data[0] == 0) {
      client.cancel(AbortCode::general, now);
    } else {
      client.on_frame(frame, now);
    }
    if (!client.busy() && client.result() == canopen::ok) (void)client.data();
  }
  for (int steps = 0; client.busy(); ++steps) {
    require(steps < 10, "a transfer ends when its server is silent");
    bus.room = 200;
    const std::optional<TimePoint> deadline = client.next_deadline();
    require(deadline.has_value(), "a transfer that runs has a deadline");
    if (*deadline > now) now = *deadline;
    client.on_time(now);
  }
  return 0;
}
