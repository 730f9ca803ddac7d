/// Captures of tcpdump and Wireshark: the frames of interfaces with the link type CAN_SOCKETCAN, and of captures of all
/// interfaces of Linux (LINUX_SLL, LINUX_SLL2). The time is in seconds since 1970 with six decimals. Packets of other
/// interfaces are skipped.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "decode/formats/capture_file.hpp"
#include "decode/formats/log_formats.hpp"
#include "decode/formats/words.hpp"

namespace edsc {
namespace {

// The packet of a frame (LINKTYPE_CAN_SOCKETCAN of https://www.tcpdump.org/linktypes.html): 32 bits, big-endian, of
// CAN-ID and flags; length; flags of CAN FD; two reserved bytes; data.
constexpr std::uint32_t extended_flag = 0x8000'0000, remote_flag = 0x4000'0000, error_flag_of_packet = 0x2000'0000;
constexpr std::uint8_t fd_frame_flag = 0x04, xl_frame_flag = 0x80;
constexpr std::size_t packet_header = 8, classic_packet = 16;

void parse_packet(std::span<const std::uint8_t> packet, LogLine& line) {
  canopen::Frame& frame = line.frame;
  if (packet.size() < packet_header) {
    line = broken(line, "the packet is shorter than the header of a frame");
    return;
  }
  if (packet.size() > classic_packet || (packet[5] & fd_frame_flag) != 0 || (packet[4] & xl_frame_flag) != 0) {
    line.kind = LogLineKind::can_fd;
    return;
  }
  const std::uint32_t word =
      std::uint32_t{packet[0]} << 24 | std::uint32_t{packet[1]} << 16 | std::uint32_t{packet[2]} << 8 | packet[3];
  const bool is_error = (word & error_flag_of_packet) != 0;
  line.kind = is_error ? LogLineKind::error_frame : LogLineKind::frame;
  frame.extended = is_error || (word & extended_flag) != 0;
  frame.remote = !is_error && (word & remote_flag) != 0;
  frame.id = word & (frame.extended ? 0x1FFF'FFFFU : 0x7FFU);
  frame.size = packet[4];
  if (frame.size > 8) {
    line = broken(line, "the length is not 0 to 8");
    return;
  }
  const auto data = packet.subspan(packet_header);
  if (frame.remote) return;
  if (data.size() < frame.size) {
    line = broken(line, "fewer bytes than the length states");
    return;
  }
  std::ranges::copy(data.first(frame.size), frame.data.begin());
}

// The headers of a capture of all interfaces, "cooked mode" of Linux: the kind of the interface and the protocol.
constexpr std::uint16_t arphrd_can = 280;
constexpr std::uint16_t can_protocol = 0x000C, can_fd_protocol = 0x000D, can_xl_protocol = 0x000E;
constexpr std::size_t sll_header = 16, sll2_header = 20;

std::uint16_t big_endian_16(std::span<const std::uint8_t> bytes, std::size_t at) {
  return static_cast<std::uint16_t>(bytes[at] << 8U | bytes[at + 1]);
}

bool has_frames(std::uint16_t link_type) {
  const auto type = static_cast<LinkType>(link_type);
  return type == LinkType::can_socketcan || type == LinkType::linux_sll || type == LinkType::linux_sll2;
}

class PacketSource final : public LogSource {
 public:
  explicit PacketSource(LogInput& input) : input_{input}, capture_{input} {}

  /// Returns a problem, or nothing.
  [[nodiscard]] std::string open() {
    if (!capture_.open(has_frames)) return fmt::format("byte {}: {}", input_.position(), capture_.problem());
    const std::vector<std::uint16_t> types = capture_.link_types();
    if (types.empty() || std::ranges::any_of(types, has_frames)) return "";
    return fmt::format("the link type is {}, not CAN_SOCKETCAN (227)", link_type_name(types.front()));
  }

  [[nodiscard]] bool next(LogLine& line) override {
    if (at_end_) return false;
    while (true) {
      line = {};
      line.byte = input_.position();
      CapturedPacket packet;
      if (!capture_.next(packet)) return end_with(line);
      line.number = ++packets_;
      if (parse(packet, line)) return true;
    }
  }

 private:
  /// The end of the log, or an error, which is a last line.
  bool end_with(LogLine& line) {
    at_end_ = true;
    if (input_.error() != 0 || capture_.problem().empty()) return false;
    line.number = ++packets_;
    line.kind = LogLineKind::unreadable;
    line.problem = capture_.problem();
    return true;
  }

  /// Returns false for a packet of an interface that is not CAN.
  [[nodiscard]] bool parse(const CapturedPacket& packet, LogLine& line) {
    if (!has_frames(packet.link_type)) return false;
    bytes_.assign(packet.bytes.begin(), packet.bytes.end());
    std::span<std::uint8_t> frame{bytes_};
    if (const auto type = static_cast<LinkType>(packet.link_type); type != LinkType::can_socketcan) {
      const bool is_first = type == LinkType::linux_sll;
      const std::size_t header = is_first ? sll_header : sll2_header;
      if (frame.size() < header || big_endian_16(frame, is_first ? 2 : 8) != arphrd_can) return false;
      const std::uint16_t protocol = big_endian_16(frame, is_first ? 14 : 0);
      if (protocol != can_protocol && protocol != can_fd_protocol && protocol != can_xl_protocol) return false;
      frame = frame.subspan(header);
      // In these captures the CAN-ID has the byte order of the capture file.
      if (!packet.is_big_endian && frame.size() >= packet_header) std::ranges::reverse(frame.first(4));
    }
    line.interface = packet.interface;
    if (packet.microseconds) {
      line.has_time = true;
      line.microseconds = std::clamp<std::int64_t>(*packet.microseconds, 0, max_log_time_us - 1);
      time_.clear();
      append_seconds(time_, line.microseconds);
      line.time = time_;
    }
    parse_packet(frame, line);
    return true;
  }

  LogInput& input_;
  CaptureFile capture_;
  bool at_end_ = false;
  std::size_t packets_ = 0;
  std::vector<std::uint8_t> bytes_;
  std::string time_;
};

bool begins_with_one_of(std::string_view beginning, std::span<const std::string_view> words) {
  return std::ranges::any_of(words, [&](std::string_view word) { return beginning.starts_with(word); });
}

bool is_pcap(std::string_view beginning) {
  // In both byte orders, with microseconds and with nanoseconds.
  constexpr std::string_view magics[] = {"\xD4\xC3\xB2\xA1", "\xA1\xB2\xC3\xD4", "\x4D\x3C\xB2\xA1",
                                         "\xA1\xB2\x3C\x4D"};
  return begins_with_one_of(beginning, magics);
}

bool is_pcapng(std::string_view beginning) {
  return beginning.starts_with("\x0A\x0D\x0D\x0A");  // the type of the Section Header Block
}

std::unique_ptr<LogSource> open_packets(LogInput& input, std::string& problem) {
  auto source = std::make_unique<PacketSource>(input);
  problem = source->open();
  return problem.empty() ? std::move(source) : nullptr;
}

}  // namespace

const LogFormat pcapng_format{"pcapng", "capture of Wireshark", is_pcapng, open_packets};
const LogFormat pcap_format{"pcap", "capture of tcpdump", is_pcap, open_packets};

}  // namespace edsc
