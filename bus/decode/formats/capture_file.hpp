/// The packets of a capture: pcap and pcapng, in both byte orders, with all time resolutions, as a stream
/// (draft-ietf-opsawg-pcap and draft-ietf-opsawg-pcapng).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "decode/formats/log_input.hpp"

namespace edsc {

/// What the packets of an interface contain: https://www.tcpdump.org/linktypes.html
enum class LinkType : std::uint16_t { linux_sll = 113, can_socketcan = 227, linux_sll2 = 276 };

/// `CAN_SOCKETCAN`, or the number.
[[nodiscard]] std::string link_type_name(std::uint16_t link_type);

/// Views are valid until the next packet is read.
struct CapturedPacket {
  std::span<const std::uint8_t> bytes;
  std::uint16_t link_type = 0;
  bool is_big_endian = false;                ///< the byte order of the capture
  std::optional<std::int64_t> microseconds;  ///< since 1970; a simple packet of pcapng does not have it
  std::string_view interface;                ///< pcapng: its name, or its number if there are several; else empty
};

class CaptureFile {
 public:
  explicit CaptureFile(LogInput& input) : input_{input} {}

  /// Reads up to the description of the first interface that `is_usable` accepts by its link type, of pcapng also past
  /// packets of others. Returns false after an error. Call it before next().
  [[nodiscard]] bool open(bool (*is_usable)(std::uint16_t link_type));

  /// Reads the next packet. Returns false at the end, and after an error.
  [[nodiscard]] bool next(CapturedPacket& packet);

  /// The error, as a clause; empty without one.
  [[nodiscard]] const std::string& problem() const { return problem_; }
  /// The link types of the interfaces that are described so far.
  [[nodiscard]] std::vector<std::uint16_t> link_types() const;

 private:
  struct Interface {
    std::uint16_t link_type = 0;
    std::uint32_t max_length = 0;          ///< of a packet; 0: not limited
    std::uint64_t per_second = 1'000'000;  ///< resolution of times
    std::int64_t offset = 0;               ///< of times, in seconds
    std::string name;
  };
  struct Block {
    std::uint32_t type = 0;
    std::size_t length = 0;  ///< of the body
  };

  [[nodiscard]] bool fail(std::string problem);
  [[nodiscard]] bool read_all(std::uint8_t* to, std::size_t count);
  [[nodiscard]] bool read_body(std::size_t length);
  [[nodiscard]] bool skip(std::size_t length);
  [[nodiscard]] std::uint64_t number(std::size_t at, std::size_t size) const;

  [[nodiscard]] bool open_pcap();
  [[nodiscard]] bool next_of_pcap(CapturedPacket& packet);

  [[nodiscard]] bool next_block();
  [[nodiscard]] bool read_section();
  [[nodiscard]] bool read_interface();
  [[nodiscard]] bool has_packet() const;
  [[nodiscard]] bool read_packet(CapturedPacket& packet);
  [[nodiscard]] bool fill(CapturedPacket& packet, std::size_t interface, std::size_t at, std::size_t length);

  LogInput& input_;
  std::string problem_;
  bool is_pcapng_ = false;
  bool is_big_endian_ = false;
  bool is_pending_ = false;  ///< `body_` is a block that next() has not used
  Block block_;
  std::vector<std::uint8_t> body_;
  std::vector<Interface> interfaces_;
  std::string interface_name_;
};

}  // namespace edsc
