/// Instructions of a node of another stack, with the frames of whole_frame.cpp and long_transfers.cpp. The SDO server
/// and the PDOs are processed after the frame without the other services.
#include "../../cortex_m/count.hpp"
#include "../../cortex_m/startup.hpp"
#include "../transfers.hpp"

#include <cstdint>
#include <node.hpp>

namespace {

PeerNode node;
volatile std::uint32_t sent_id = 0;
volatile std::uint32_t sent_words[2]{};
std::uint32_t sent = 0;
volatile std::uint32_t ramp_register = 0;

/// As from a driver: the compiler does not see which frame it is.
[[gnu::noinline]] void receive(std::uint32_t id, std::uint32_t size, std::uint32_t first = 0,
                               std::uint32_t second = 0) {
  node.receive(id, size, first, second);
}

void request(std::uint32_t first, std::uint32_t second) {
  receive(0x605, 8, first, second);
  while (node.process_sdo(0)) {
  }
}

std::uint8_t exchange(const Bytes& bytes) {
  std::uint32_t words[2];
  __builtin_memcpy(words, bytes.data(), sizeof words);
  request(words[0], words[1]);
  return static_cast<std::uint8_t>(sent_words[0]);
}

#ifdef PEER_BLOCK
/// The block download of transfers.hpp in blocks of the size that the server wants, with the CRC.
void download_in_blocks() {
  exchange(initiate(0xC4));
  std::uint32_t block = sent_words[1] & 0x7F;
  std::uint32_t sequence = 0;
  for (std::uint32_t done = 0; done < domain_bytes; done += segment_bytes) {
    ++sequence;
    const std::uint32_t end = domain_bytes - done <= segment_bytes ? 0x80 : 0;
    exchange({static_cast<std::uint8_t>(sequence | end), 1, 2, 3, 4, 5, 6, 7});
    if (sequence != block) continue;
    sequence = 0;
    block = sent_words[0] >> 16 & 0x7F;
  }
  exchange({static_cast<std::uint8_t>(0xC1 | unused_bytes << 2), PEER_DOWNLOAD_CRC & 0xFF, PEER_DOWNLOAD_CRC >> 8});
}
#endif

/// Prints a mean of calls each of which must send this number of frames.
template <class F>
void print_sending(const char* name, std::uint32_t frames, F run) {
  const std::uint32_t before = sent;
  run(0);
  if (sent - before == frames) print_mean(name, run);
}

template <class Transfer>
void print_per_byte(const char* name, Transfer transfer) {
  const std::uint32_t before = sent;
  const std::uint32_t instructions = count([&] { transfer(exchange); });
  const bool is_aborted = (sent_words[0] & 0xFF) == 0x80;
  if (sent - before > 8 && !is_aborted) print(name, instructions, domain_bytes);
}

}  // namespace

volatile std::uint32_t& PeerNode::ramp() { return ramp_register; }

[[gnu::noinline]] bool transmit(std::uint32_t id, std::uint32_t /*size*/, const std::uint32_t (&words)[2]) {
  sent_id = id;
  sent_words[0] = words[0];
  sent_words[1] = words[1];
  ++sent;
  return true;
}

void program() {
  start_counter();
  node.start();
  node.process(0);            // boot-up
  receive(0x000, 2, 0x0501);  // NMT: start node 5
  node.process(0);
  node.process(0);
  print_sending("on-time", 0, [](std::uint32_t) { node.process(0); });
  print_sending("rpdo", 0, [](std::uint32_t) { receive(0x305, 8, 1, 2); });
  print_sending("foreign", 0, [](std::uint32_t) { receive(0x1A3, 8, 1, 2); });         // a TPDO of node 35
  print_sending("upload", 1, [](std::uint32_t) { request(0x0060'8440, 0); });          // 6084h
  print_sending("download", 1, [](std::uint32_t i) { request(0x0060'8423, i + 1); });  // with a new value
  print_sending("sync-cycle", 4, [](std::uint32_t i) {
    for (const std::uint32_t id : {0x205u, 0x305u, 0x405u, 0x505u}) receive(id, 8, i, id);
    receive(0x80, 0);
    node.process_pdos(0);
  });
  print_per_byte("segmented-upload", [](auto server) { upload_segments(server); });
  print_per_byte("segmented-download", [](auto server) { download_segments(server); });
#ifdef PEER_BLOCK
  print_per_byte("block-upload", [](auto server) { upload_blocks(server); });
  print_per_byte("block-download", [](auto) { download_in_blocks(); });
#endif
  end_program();
}
