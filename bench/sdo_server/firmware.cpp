/// An SDO server alone on a Cortex-M: for its size, and to count its instructions under QEMU (machine mps2-an386).
#include <array>
#include <canopen/object_store.hpp>
#include <canopen/sdo_server.hpp>
#include <cstdint>
#include <cstring>
#include <device/device.hpp>
#include <span>

extern "C" {
extern std::uint32_t edsc_stack_top;
extern std::uint32_t __bss_start__;
extern std::uint32_t __bss_end__;
extern std::uint32_t __data_start__;
extern std::uint32_t __data_end__;
extern std::uint32_t __data_load__;
[[noreturn]] void reset();
[[gnu::section(".vectors"), gnu::used]] const void* const vectors[] = {&edsc_stack_top,
                                                                       reinterpret_cast<const void*>(reset)};
}

namespace {

using Bytes = std::array<std::uint8_t, 8>;

#ifdef WITH_SERVER
struct Device : device::Device {
  static constexpr canopen::DeviceOptions options = [] {
    canopen::DeviceOptions options;
#ifdef WITH_BLOCK
    options.sdo_block_transfer = true;
#endif
    return options;
  }();
};

constinit canopen::ObjectStore<Device> store;
constinit canopen::SdoServer<Device> server;

struct Hooks {
  static canopen::EntryAccess entries() { return store.entries(); }
  static canopen::AbortCode before_read(std::uint16_t, std::uint8_t) { return canopen::ok; }
  static canopen::AbortCode before_write(std::uint16_t, std::uint8_t, std::span<std::uint8_t>) { return canopen::ok; }
  static void after_write(std::uint16_t, std::uint8_t) {}
  static canopen::AbortCode command(std::uint16_t, std::uint8_t, std::span<const std::uint8_t>) {
    return canopen::AbortCode::not_stored;
  }
};

[[gnu::noinline]] void ask(const Bytes& request) { server.on_request(request, Hooks{}, canopen::TimePoint{}); }
#endif

/// Where the frames come from and go to.
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

[[maybe_unused, gnu::noinline]] void transmit(const Bytes& bytes) {
  std::uint32_t words[2];
  std::memcpy(words, bytes.data(), sizeof words);
  mailbox.words[0] = words[0];
  mailbox.words[1] = words[1];
}

#ifdef COUNT
constexpr std::uint32_t instructions_per_tick = 40;  // SysTick runs at 25 MHz, an instruction takes 1 ns
volatile std::uint32_t& systick(std::uint32_t offset) {
  return *reinterpret_cast<volatile std::uint32_t*>(0xE000'E010u + offset);
}

std::uint32_t semihosting(std::uint32_t operation, const void* argument) {
  register std::uint32_t r0 asm("r0") = operation;
  register const void* r1 asm("r1") = argument;
  asm volatile("bkpt 0xAB" : "+r"(r0) : "r"(r1) : "memory");
  return r0;
}
constexpr std::uint32_t write_text = 0x04;
constexpr std::uint32_t exit_program = 0x18;

void print(const char* name, std::uint32_t instructions, std::uint32_t units) {
  char line[64];
  std::size_t at = 0;
  while (*name != 0) line[at++] = *name++;
  line[at++] = ' ';
  char digits[12];
  std::size_t count = 0;
  for (std::uint32_t tenths = static_cast<std::uint32_t>(std::uint64_t{instructions} * 10 / units);
       count < 2 || tenths != 0; tenths /= 10) {
    digits[count++] = static_cast<char>('0' + tenths % 10);
    if (count == 1) digits[count++] = '.';
  }
  if (digits[count - 1] == '.') digits[count++] = '0';
  while (count != 0) line[at++] = digits[--count];
  line[at++] = '\n';
  line[at] = 0;
  semihosting(write_text, line);
}

/// Instructions of `run`.
template <class F>
std::uint32_t count(F run) {
  const std::uint32_t before = systick(8);
  run();
  return ((before - systick(8)) & 0xFF'FFFF) * instructions_per_tick;
}

void exchange(const Bytes& request) {
  ask(request);
  while (server.has_reply()) {
    transmit(server.reply());
    server.reply_sent(Hooks{}, canopen::TimePoint{});
  }
}

constexpr std::uint32_t repeats = 1000;
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

#ifdef WITH_BLOCK
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

void measure() {
  systick(4) = 0xFF'FFFF;
  systick(8) = 0;
  systick(0) = 5;
  store.reset_application(canopen::NodeId{5});
  store.reset_communication(canopen::NodeId{5});
  bind_domain();
  const auto repeat = [&](const Bytes& request) {
    return count([&] {
      for (std::uint32_t i = 0; i < repeats; ++i) exchange(request);
    });
  };
  print("expedited-upload", repeat({0x40, 0x17, 0x10, 0, 0, 0, 0, 0}), repeats);
  print("expedited-download", repeat({0x2B, 0x17, 0x10, 0, 0xE8, 3, 0, 0}), repeats);
  print("segmented-upload-per-byte", count(upload_segments), domain_bytes);
  print("segmented-download-per-byte", count(download_segments), domain_bytes);
#ifdef WITH_BLOCK
  print("block-upload-per-byte", count(upload_blocks), domain_bytes);
  bind_domain();
  print("block-download-per-byte", count(download_blocks), domain_bytes);
#endif
  semihosting(exit_program, reinterpret_cast<const void*>(0x20026));
}
#endif

}  // namespace

extern "C" void reset() {
  for (std::uint32_t *from = &__data_load__, *to = &__data_start__; to != &__data_end__;) *to++ = *from++;
  for (std::uint32_t* to = &__bss_start__; to != &__bss_end__;) *to++ = 0;
#ifdef COUNT
  measure();
#endif
  for (;;) {
#ifdef WITH_SERVER
    ask(receive());
    if (server.has_reply()) {
      transmit(server.reply());
      server.reply_sent(Hooks{}, canopen::TimePoint{});
    }
#endif
  }
}
