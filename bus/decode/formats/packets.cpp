/// Captures of tcpdump and Wireshark: pcap and pcapng with the link type CAN_SOCKETCAN. The time is in seconds since
/// 1970 with six decimals; there is no name of an interface.
#include <fmt/format.h>
#include <pcap/pcap.h>
#include <stdio.h>  // fopencookie

#include <algorithm>
#include <array>
#include <memory>
#include <span>
#include <string>
#include <string_view>

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

class PacketSource final : public LogSource {
 public:
  explicit PacketSource(LogInput& input) : input_{input} {}
  PacketSource(const PacketSource&) = delete;
  PacketSource& operator=(const PacketSource&) = delete;
  ~PacketSource() override {
    if (capture_ != nullptr) pcap_close(capture_);
  }

  /// Returns a problem, or nothing.
  [[nodiscard]] std::string open() {
    const cookie_io_functions_t functions{read, nullptr, nullptr, nullptr};
    std::FILE* const file = ::fopencookie(&input_, "r", functions);
    if (file == nullptr) return "not enough memory";
    std::setvbuf(file, nullptr, _IONBF, 0);  // packets of a pipe are available at once, and their offset is known
    std::array<char, PCAP_ERRBUF_SIZE> error{};
    capture_ = pcap_fopen_offline(file, error.data());
    if (capture_ == nullptr) {
      std::fclose(file);
      return fmt::format("byte {}: {}", input_.position(), error.data());
    }
    const int link_type = pcap_datalink(capture_);
    if (link_type == DLT_CAN_SOCKETCAN) return "";
    const char* const name = pcap_datalink_val_to_name(link_type);
    return fmt::format("the link type is {}, not CAN_SOCKETCAN (227)",
                       name != nullptr ? name : std::to_string(link_type));
  }

  [[nodiscard]] bool next(LogLine& line) override {
    if (at_end_) return false;
    line = {};
    line.byte = input_.position();
    pcap_pkthdr* header = nullptr;
    const u_char* bytes = nullptr;
    const int result = pcap_next_ex(capture_, &header, &bytes);
    at_end_ = result != 1;
    if (result == PCAP_ERROR_BREAK || input_.error() != 0) return false;
    line.number = ++packets_;
    if (result != 1) {
      problem_ = pcap_geterr(capture_);
      line.kind = LogLineKind::unreadable;
      line.problem = problem_;
      return true;
    }
    line.has_time = true;
    const std::int64_t seconds = std::clamp<std::int64_t>(header->ts.tv_sec, 0, max_log_time_us / 1'000'000 - 1);
    line.microseconds = seconds * 1'000'000 + std::clamp<std::int64_t>(header->ts.tv_usec, 0, 999'999);
    time_.clear();
    append_seconds(time_, line.microseconds);
    line.time = time_;
    parse_packet({bytes, header->caplen}, line);
    return true;
  }

 private:
  static ssize_t read(void* input, char* to, std::size_t most) {
    return static_cast<ssize_t>(static_cast<LogInput*>(input)->read(to, most));
  }

  LogInput& input_;
  pcap_t* capture_ = nullptr;
  bool at_end_ = false;
  std::size_t packets_ = 0;
  std::string time_, problem_;
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
