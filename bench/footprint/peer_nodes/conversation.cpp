/// Checks that a node of another stack works: prints for each step 1 if it sends exactly the expected frames, else 0.
#include "../../cortex_m/count.hpp"
#include "../../cortex_m/startup.hpp"

#include <array>
#include <cstdint>
#include <initializer_list>
#include <node.hpp>

namespace {

struct PeerMessage {
  std::uint32_t id;
  std::uint32_t size;
  std::uint32_t first = 0;
  std::uint32_t second = 0;
  friend bool operator==(const PeerMessage&, const PeerMessage&) = default;
};

PeerNode node;
std::array<PeerMessage, 16> sent;
std::uint32_t sent_count = 0;
volatile std::uint32_t ramp_register = 0;
constexpr std::uint32_t millisecond = 1000;

bool has_sent(std::initializer_list<PeerMessage> expected) {
  if (sent_count != expected.size()) return false;
  for (std::uint32_t i = 0; const PeerMessage& message : expected) {
    if (sent[i++] != message) return false;
  }
  return true;
}

/// Processes the node, until `elapsed` us are over.
void run(std::uint32_t elapsed = 0) {
  for (std::uint32_t i = 0; i < 8; ++i) node.process(0);
  for (; elapsed >= millisecond; elapsed -= millisecond) node.process(millisecond);
}

void receive(const PeerMessage& message) { node.receive(message.id, message.size, message.first, message.second); }

/// Receives a frame, and checks which are sent after it.
void expect(const char* step, const PeerMessage& message, std::initializer_list<PeerMessage> expected) {
  sent_count = 0;
  receive(message);
  run();
  print(step, has_sent(expected) ? 1 : 0, 1);
}

void expect_sdo(const char* step, std::uint32_t first, std::uint32_t second, std::uint32_t answer,
                std::uint32_t value) {
  expect(step, {0x605, 8, first, second}, {{0x585, 8, answer, value}});
}

void check_start() {
  sent_count = 0;
  const bool is_started = node.start();
  node.process(0);
  print("boot-up", is_started && has_sent({{0x705, 1, 0}}) ? 1 : 0, 1);
  run();
}

void check_server() {
  expect_sdo("upload-1000h", 0x0010'0040, 0, 0x0010'0043, 0x0002'0192);
  expect_sdo("download-6083h", 0x0060'8323, 0x1234'5678, 0x0060'8360, 0);
  print("written-6083h", ramp_register == 0x1234'5678 ? 1 : 0, 1);
  expect_sdo("upload-6083h", 0x0060'8340, 0, 0x0060'8343, 0x1234'5678);
  expect_sdo("download-of-a-constant", 0x0010'0023, 1, 0x0010'0080, 0x0601'0002);
  expect_sdo("upload-without-object", 0x0050'0040, 0, 0x0050'0080, 0x0602'0000);
  expect_sdo("initiate-segments", 0x0010'0840, 0, 0x0010'0841, 18);  // 1008h: CANopen peer bench
  expect_sdo("segment-1", 0x60, 0, 0x4E41'4300, 0x6E65'706F);
  expect_sdo("segment-2", 0x70, 0, 0x6570'2010, 0x6220'7265);
  expect_sdo("segment-3", 0x60, 0, 0x636E'6507, 0x68);
}

void check_pdos() {
  receive({0x000, 2, 0x0501});  // NMT: start node 5
  run();
  receive({0x205, 8, 0x0403'0201, 0x0807'0605});  // RPDO 1: 607Ah, 6040h, 6060h, 2001h
  run();
  expect_sdo("rpdo-waits-for-sync", 0x0060'7A40, 0, 0x0060'7A43, 0);
  sent_count = 0;
  receive({0x80, 0});
  run();
  bool is_all = sent_count == 4;
  for (std::uint32_t i = 0; i < 4; ++i) is_all = is_all && sent[i].id == 0x185 + 0x100 * i && sent[i].size == 8;
  print("tpdos-at-sync", is_all ? 1 : 0, 1);
  expect_sdo("rpdo-after-sync", 0x0060'7A40, 0, 0x0060'7A43, 0x0403'0201);
  expect_sdo("rpdo-last-object", 0x0020'0140, 0, 0x0020'014F, 8);
}

void check_errors() {
  sent_count = 0;
  node.check(true);
  run();
  print("emergency", has_sent({{0x85, 8, PeerNode::emergency, 0}}) ? 1 : 0, 1);
  expect_sdo("history", 0x0110'0340, 0, 0x0110'0343, PeerNode::error_in_history);
  sent_count = 0;
  node.check(false);
  run();
  print("emergency-over", has_sent({{0x85, 8, PeerNode::emergency_over, 0}}) ? 1 : 0, 1);
}

void check_heartbeat() {
  sent_count = 0;
  run(1000 * millisecond);
  print("heartbeat", has_sent({{0x705, 1, 5}}) ? 1 : 0, 1);
}

#ifdef PEER_DYNAMIC
/// TPDO 1 gets 2001h as its only object, and event-driven transmission with an event timer of 10 ms.
void check_mapping() {
  expect_sdo("disable-tpdo", 0x0118'0023, 0xC000'0185, 0x0118'0060, 0);
  expect_sdo("clear-mapping", 0x001A'002F, 0, 0x001A'0060, 0);
  expect_sdo("map", 0x011A'0023, 0x2001'0008, 0x011A'0060, 0);
  expect_sdo("set-mapping", 0x001A'002F, 1, 0x001A'0060, 0);
  expect_sdo("set-type", 0x0218'002F, 254, 0x0218'0060, 0);
  expect_sdo("set-event-timer", 0x0518'002B, 10, 0x0518'0060, 0);
  sent_count = 0;
  receive({0x605, 8, 0x0118'0023, 0x4000'0185});
  run(12 * millisecond);
  bool is_all = sent_count >= 2 && sent[0] == PeerMessage{0x585, 8, 0x0118'0060, 0};
  for (std::uint32_t i = 1; i < sent_count; ++i) is_all = is_all && sent[i] == PeerMessage{0x185, 1, 8};
  print("mapped-tpdo", is_all ? 1 : 0, 1);
}
#endif

#ifdef PEER_BLOCK
void check_block_upload() {
  expect("initiate-block", {0x605, 8, 0x0010'08A4, 127}, {{0x585, 8, 0x0010'08C6, 18}});
  expect("blocks", {0x605, 8, 0xA3, 0},
         {{0x585, 8, 0x4E41'4301, 0x6E65'706F}, {0x585, 8, 0x6570'2002, 0x6220'7265}, {0x585, 8, 0x636E'6583, 0x68}});
  sent_count = 0;
  receive({0x605, 8, 0x007F'03A2, 0});
  run();
  print("crc", has_sent({{0x585, 8, PEER_CRC << 8 | 0xCD, 0}}) ? 1 : 0, 1);
  expect("end-block", {0x605, 8, 0xA1, 0}, {});
}
#endif

}  // namespace

volatile std::uint32_t& PeerNode::ramp() { return ramp_register; }

bool transmit(std::uint32_t id, std::uint32_t size, const std::uint32_t (&words)[2]) {
  constexpr std::uint32_t byte_masks[] = {0, 0xFF};
  const std::uint32_t mask = size < 2 ? byte_masks[size] : 0xFFFF'FFFF;
  if (sent_count < sent.size()) sent[sent_count] = {id, size, words[0] & mask, size < 8 ? 0 : words[1]};
  ++sent_count;
  return true;
}

void program() {
  check_start();
  check_server();
  check_pdos();
  check_errors();
  check_heartbeat();
#ifdef PEER_BLOCK
  check_block_upload();
#endif
#ifdef PEER_DYNAMIC
  check_mapping();
#endif
  print("end", 1, 1);
  end_program();
}
