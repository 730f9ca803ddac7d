/// The SDO server alone, to measure its size, and with COUNT its instructions.
#include "../cortex_m/startup.hpp"
#ifdef COUNT
#include "../cortex_m/count.hpp"
#endif

#include <array>
#include <canopen/od/object_store.hpp>
#include <canopen/sdo/sdo_server.hpp>
#include <cstdint>
#include <cstring>
#include <device/device.hpp>
#include <span>

namespace {

using Bytes = std::array<std::uint8_t, 8>;

constinit canopen::ObjectStore<device::Device> store;
constinit canopen::SdoServer<device::Device> server;

struct Hooks {
  static auto entries() { return store.entries(); }
  static canopen::AbortCode before_read(std::uint16_t, std::uint8_t) { return canopen::ok; }
  static canopen::AbortCode before_write(std::uint16_t, std::uint8_t, std::span<std::uint8_t>) { return canopen::ok; }
  static void after_write(std::uint16_t, std::uint8_t) {}
  static canopen::AbortCode command(std::uint16_t, std::uint8_t, std::span<const std::uint8_t>) {
    return canopen::AbortCode::not_stored;
  }
};

[[gnu::noinline]] void ask(const Bytes& request) { server.on_request(request, Hooks{}, canopen::TimePoint{}); }

/// Source and destination of the frames.
struct Mailbox {
  volatile std::uint32_t words[2];
};
Mailbox mailbox;

[[maybe_unused]] Bytes receive() {
  const std::uint32_t words[2] = {mailbox.words[0], mailbox.words[1]};
  Bytes bytes;
  std::memcpy(bytes.data(), words, sizeof words);
  return bytes;
}

[[gnu::noinline]] void transmit(const Bytes& bytes) {
  std::uint32_t words[2];
  std::memcpy(words, bytes.data(), sizeof words);
  mailbox.words[0] = words[0];
  mailbox.words[1] = words[1];
}

void exchange(const Bytes& request) {
  ask(request);
  while (server.has_reply()) {
    transmit(server.reply());
    server.reply_sent(Hooks{}, canopen::TimePoint{});
  }
}

#ifdef COUNT
constexpr std::uint32_t domain_bytes = 8192;
std::uint8_t memory[domain_bytes];

void bind_domain() {
  device::od::blob_8k::type domain{memory, domain_bytes, domain_bytes};
  store.set<device::od::blob_8k>(domain);
}

Bytes with_index(std::uint8_t command, std::uint16_t index, std::uint8_t fourth = 0, std::uint8_t fifth = 0) {
  return {command, static_cast<std::uint8_t>(index), static_cast<std::uint8_t>(index >> 8), 0, fourth, fifth, 0, 0};
}

void upload_segments() {
  exchange(with_index(0x40, device::od::blob_8k::index));
  std::uint8_t command = 0x60;
  do {
    exchange({command});
    command ^= 0x10;
  } while ((server.reply()[0] & 1) == 0);
}

void download_segments() {
  exchange(with_index(0x20, device::od::blob_8k::index));
  std::uint8_t command = 0x00;
  for (std::uint32_t sent = 0; sent < domain_bytes; sent += 7) {
    const std::uint32_t left = domain_bytes - sent;
    const auto end = static_cast<std::uint8_t>(left <= 7 ? ((7 - left) << 1) | 1 : 0);
    exchange({static_cast<std::uint8_t>(command | end), 1, 2, 3, 4, 5, 6, 7});
    command ^= 0x10;
  }
}

void upload_blocks() {
  exchange(with_index(0xA4, device::od::blob_8k::index, 127));
  exchange({0xA3});
  while (server.reply()[0] != 0xC1 + ((7 - domain_bytes % 7) % 7 << 2))
    exchange({0xA2, static_cast<std::uint8_t>(server.reply()[0] & 0x7F), 127});
  exchange({0xA1});
}

void download_blocks() {
  exchange(with_index(0xC4, device::od::blob_8k::index));
  std::uint8_t sequence = 0;
  for (std::uint32_t sent = 0; sent < domain_bytes; sent += 7) {
    ++sequence;
    const auto end = static_cast<std::uint8_t>(domain_bytes - sent <= 7 ? 0x80 : 0);
    exchange({static_cast<std::uint8_t>(sequence | end), 1, 2, 3, 4, 5, 6, 7});
    if (sequence == 127) sequence = 0;
  }
  exchange({static_cast<std::uint8_t>(0xC1 | ((7 - domain_bytes % 7) % 7 << 2)), 0, 0});
}
#endif

}  // namespace

void program() {
#ifdef COUNT
  start_counter();
  store.reset_application(canopen::NodeId{5});
  store.reset_communication(canopen::NodeId{5});
  bind_domain();
  print_mean("expedited-upload", [](std::uint32_t) { exchange({0x40, 0x17, 0x10, 0, 0, 0, 0, 0}); });
  print_mean("expedited-download", [](std::uint32_t) { exchange({0x2B, 0x17, 0x10, 0, 0xE8, 3, 0, 0}); });
  print("segmented-upload-per-byte", count(upload_segments), domain_bytes);
  print("segmented-download-per-byte", count(download_segments), domain_bytes);
  if constexpr (device::Device::options.sdo_block_transfer) {
    print("block-upload-per-byte", count(upload_blocks), domain_bytes);
    bind_domain();
    print("block-download-per-byte", count(download_blocks), domain_bytes);
  }
  end_program();
#else
  for (;;) exchange(receive());
#endif
}
