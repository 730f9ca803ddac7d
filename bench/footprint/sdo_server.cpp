/// The SDO server alone, to measure its size, and with COUNT its instructions.
#include "../cortex_m/startup.hpp"
#include "transfers.hpp"
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

constinit canopen::ObjectStore<device::Device> store;
constinit canopen::SdoServer<device::Device> server;

struct Hooks {
  static auto entries() { return store.entries(); }
  static canopen::AbortCode before_read(std::uint16_t, std::uint8_t) { return canopen::ok; }
  static canopen::AbortCode write(std::uint16_t, std::uint8_t, canopen::entry::Word word,
                                  std::span<std::uint8_t> bytes) {
    store.entries().write(word, bytes);
    return canopen::ok;
  }
  static void written(std::uint16_t, std::uint8_t) {}
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

std::uint8_t exchange(const Bytes& request) {
  ask(request);
  while (server.has_reply()) {
    transmit(server.reply());
    server.reply_sent(Hooks{}, canopen::TimePoint{});
  }
  return server.reply()[0];
}

#ifdef COUNT
std::uint8_t memory[domain_bytes];

void bind_domain() {
  device::od::blob_8k::type domain{memory, domain_bytes, domain_bytes};
  store.set<device::od::blob_8k>(domain);
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
  print("segmented-upload-per-byte", count([] { upload_segments(exchange); }), domain_bytes);
  print("segmented-download-per-byte", count([] { download_segments(exchange); }), domain_bytes);
  if constexpr (device::Device::options.sdo_block_transfer) {
    print("block-upload-per-byte", count([] { upload_blocks(exchange); }), domain_bytes);
    bind_domain();
    print("block-download-per-byte", count([] { download_blocks(exchange); }), domain_bytes);
  }
  end_program();
#else
  for (;;) exchange(receive());
#endif
}
