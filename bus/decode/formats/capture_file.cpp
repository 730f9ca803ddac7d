#include "decode/formats/capture_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

namespace edsc {
namespace {

constexpr std::uint32_t section_header = 0x0A0D0D0A, interface_description = 1, old_packet = 2, simple_packet = 3,
                        enhanced_packet = 6;
constexpr std::uint32_t byte_order_magic = 0x1A2B3C4D;
constexpr std::uint32_t microsecond_magic = 0xA1B2C3D4, nanosecond_magic = 0xA1B23C4D;
constexpr std::uint16_t end_of_options = 0, interface_name = 2, time_resolution = 9, time_offset = 14;

/// A longer packet or block is the sign of a damaged file.
constexpr std::size_t max_length = std::size_t{1} << 24;

struct LinkTypeRow {
  std::uint16_t number;
  std::string_view name;
};
constexpr LinkTypeRow link_type_rows[] = {
    {0, "NULL"},
    {1, "EN10MB"},
    {101, "RAW"},
    {105, "IEEE802_11"},
    {113, "LINUX_SLL"},
    {127, "IEEE802_11_RADIO"},
    {189, "USB_LINUX"},
    {190, "CAN20B"},
    {220, "USB_LINUX_MMAPPED"},
    {227, "CAN_SOCKETCAN"},
    {249, "USBPCAP"},
    {276, "LINUX_SLL2"},
};

std::uint64_t number_in(const std::uint8_t* bytes, std::size_t size, bool is_big_endian) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < size; ++i) value = value << 8U | bytes[is_big_endian ? i : size - 1 - i];
  return value;
}

constexpr std::size_t padded(std::size_t length) { return (length + 3) / 4 * 4; }

/// Ticks as microseconds, rounded down.
std::int64_t microseconds_of(std::uint64_t ticks, std::uint64_t per_second) {
  constexpr std::uint64_t second = 1'000'000;
  const std::uint64_t seconds = ticks / per_second;
  const std::uint64_t rest = ticks % per_second;
  const std::uint64_t fraction =
      per_second <= (std::uint64_t{1} << 40U) ? rest * second / per_second : rest / (per_second / second);
  constexpr std::uint64_t max_seconds = std::uint64_t{1} << 42U;
  return static_cast<std::int64_t>(std::min(seconds, max_seconds) * second + std::min(fraction, second - 1));
}

/// The ticks in a second: 10^-n, or 2^-n with bit 7. 0 if it has more than 64 bits.
std::uint64_t resolution_of(std::uint8_t option) {
  const unsigned exponent = option & 0x7FU;
  if ((option & 0x80U) != 0) return exponent < 64 ? std::uint64_t{1} << exponent : 0;
  if (exponent > 19) return 0;
  std::uint64_t per_second = 1;
  for (unsigned i = 0; i < exponent; ++i) per_second *= 10;
  return per_second;
}

}  // namespace

std::string link_type_name(std::uint16_t link_type) {
  const auto* const row = std::ranges::find(link_type_rows, link_type, &LinkTypeRow::number);
  return row != std::end(link_type_rows) ? std::string{row->name} : fmt::format("{}", link_type);
}

bool CaptureFile::fail(std::string problem) {
  if (input_.error() == 0) problem_ = std::move(problem);
  return false;
}

bool CaptureFile::read_all(std::uint8_t* to, std::size_t count) {
  while (count > 0) {
    const std::size_t got = input_.read(reinterpret_cast<char*>(to), count);
    if (got == 0) return false;
    to += got;
    count -= got;
  }
  return true;
}

bool CaptureFile::read_body(std::size_t length) {
  body_.resize(length);
  return read_all(body_.data(), length) || fail("the capture ends within a packet");
}

std::uint64_t CaptureFile::number(std::size_t at, std::size_t size) const {
  return number_in(body_.data() + at, size, is_big_endian_);
}

std::vector<std::uint16_t> CaptureFile::link_types() const {
  std::vector<std::uint16_t> types;
  for (const Interface& one : interfaces_) types.push_back(one.link_type);
  return types;
}

bool CaptureFile::open(bool (*is_usable)(std::uint16_t link_type)) {
  std::uint8_t magic[4];
  if (!read_all(magic, sizeof magic)) return fail("the capture is empty");
  is_pcapng_ = number_in(magic, 4, true) == section_header;
  if (!is_pcapng_) {
    body_.assign(std::begin(magic), std::end(magic));
    return open_pcap();
  }
  block_.type = section_header;
  if (!read_section()) return false;
  while (next_block()) {
    is_pending_ = false;
    if (!interfaces_.empty() && is_usable(interfaces_.back().link_type)) return true;
  }
  return problem_.empty() && input_.error() == 0;
}

bool CaptureFile::next(CapturedPacket& packet) {
  packet = {};
  if (!problem_.empty()) return false;
  if (!is_pcapng_) return next_of_pcap(packet);
  while (is_pending_ || next_block()) {
    if (std::exchange(is_pending_, false)) return read_packet(packet);
  }
  return false;
}

// pcap

bool CaptureFile::open_pcap() {
  for (const bool is_big_endian : {false, true}) {
    const auto magic = static_cast<std::uint32_t>(number_in(body_.data(), 4, is_big_endian));
    if (magic != microsecond_magic && magic != nanosecond_magic) continue;
    is_big_endian_ = is_big_endian;
    Interface one;
    one.per_second = magic == nanosecond_magic ? 1'000'000'000 : 1'000'000;
    constexpr std::size_t rest = 20;  // versions, time zone, accuracy, maximum length, link type
    if (!read_body(rest)) return fail("the capture ends within its header");
    if (const auto version = number(0, 2); version != 2) return fail(fmt::format("version {} of pcap", version));
    one.link_type = static_cast<std::uint16_t>(number(16, 2 + 2) & 0xFFFF);
    interfaces_.push_back(std::move(one));
    return true;
  }
  return fail("neither pcap nor pcapng");
}

bool CaptureFile::next_of_pcap(CapturedPacket& packet) {
  constexpr std::size_t header = 16;
  body_.resize(header);
  if (!read_all(body_.data(), 1)) return false;  // the end
  if (!read_all(body_.data() + 1, header - 1)) return fail("the capture ends within the header of a packet");
  const Interface& one = interfaces_.front();
  const std::uint64_t seconds = number(0, 4);
  const std::uint64_t ticks = std::min(number(4, 4), one.per_second - 1);
  const auto length = static_cast<std::size_t>(number(8, 4));
  if (length > max_length) return fail(fmt::format("a packet of {} bytes", length));
  if (!read_body(length)) return false;
  packet.bytes = body_;
  packet.link_type = one.link_type;
  packet.is_big_endian = is_big_endian_;
  packet.microseconds = microseconds_of(seconds * one.per_second + ticks, one.per_second);
  return true;
}

// pcapng

/// Reads the next block: the description of an interface, or a packet, which is pending then. Others are skipped.
bool CaptureFile::next_block() {
  constexpr std::size_t header = 8, trailer = 4;
  body_.resize(header);
  if (!read_all(body_.data(), 1)) return false;  // the end
  if (!read_all(body_.data() + 1, header - 1 - 4)) return fail("the capture ends within the header of a block");
  block_.type = static_cast<std::uint32_t>(number(0, 4));
  if (block_.type == section_header) return read_section();
  if (!read_all(body_.data() + 4, 4)) return fail("the capture ends within the header of a block");
  const auto total = static_cast<std::size_t>(number(4, 4));
  if (total < header + trailer || total % 4 != 0) return fail(fmt::format("a block of {} bytes", total));
  block_.length = total - header - trailer;
  if (block_.type != interface_description && !has_packet()) return skip(block_.length + trailer);
  if (total > max_length) return fail(fmt::format("a block of {} bytes", total));
  if (!read_body(block_.length + trailer)) return false;
  if (number(block_.length, trailer) != total) return fail("the two lengths of a block differ");
  if (block_.type == interface_description) return read_interface();
  is_pending_ = true;
  return true;
}

bool CaptureFile::has_packet() const {
  return block_.type == enhanced_packet || block_.type == simple_packet || block_.type == old_packet;
}

bool CaptureFile::skip(std::size_t length) {
  constexpr std::size_t at_once = 4096;
  for (std::size_t left = length; left > 0; left -= std::min(left, at_once)) {
    if (!read_body(std::min(left, at_once))) return fail("the capture ends within a block");
  }
  return true;
}

/// Reads the section header after its type. Its first number shows the byte order; the interfaces of the section before
/// do not exist any more.
bool CaptureFile::read_section() {
  constexpr std::size_t fixed = 12;  // type, length, byte order
  std::uint8_t start[8];
  if (!read_all(start, sizeof start)) return fail("the capture ends within the header of a section");
  is_big_endian_ = number_in(start + 4, 4, true) == byte_order_magic;
  if (!is_big_endian_ && number_in(start + 4, 4, false) != byte_order_magic)
    return fail("a section without byte order");
  const auto total = static_cast<std::size_t>(number_in(start, 4, is_big_endian_));
  if (total < fixed + 16 || total % 4 != 0) return fail(fmt::format("a section header of {} bytes", total));
  if (!read_body(4)) return false;
  if (const auto version = number(0, 2); version != 1) return fail(fmt::format("version {} of pcapng", version));
  interfaces_.clear();
  return skip(total - fixed - 4);
}

bool CaptureFile::read_interface() {
  constexpr std::size_t fixed = 8;
  if (block_.length < fixed) return fail("the description of an interface is too short");
  Interface one;
  one.link_type = static_cast<std::uint16_t>(number(0, 2));
  one.max_length = static_cast<std::uint32_t>(number(4, 4));
  for (std::size_t at = fixed; at + 4 <= block_.length;) {
    const auto code = static_cast<std::uint16_t>(number(at, 2));
    const auto length = static_cast<std::size_t>(number(at + 2, 2));
    at += 4;
    if (code == end_of_options || length > block_.length - at) break;
    if (code == interface_name) one.name.assign(reinterpret_cast<const char*>(body_.data()) + at, length);
    if (code == time_resolution && length == 1) one.per_second = resolution_of(body_[at]);
    if (code == time_offset && length == 8) one.offset = static_cast<std::int64_t>(number(at, 8));
    at += std::min(padded(length), block_.length - at);
  }
  if (one.per_second == 0) return fail("the times of an interface have an unknown resolution");
  constexpr std::size_t max_interfaces = 1000;
  if (interfaces_.size() == max_interfaces) return fail(fmt::format("more than {} interfaces", max_interfaces));
  interfaces_.push_back(std::move(one));
  return true;
}

bool CaptureFile::fill(CapturedPacket& packet, std::size_t interface, std::size_t at, std::size_t length) {
  if (interface >= interfaces_.size())
    return fail(fmt::format("a packet of interface {}, which is unknown", interface));
  if (at > block_.length || length > block_.length - at) return fail("a packet that is longer than its block");
  const Interface& one = interfaces_[interface];
  packet.bytes = std::span<const std::uint8_t>{body_}.subspan(at, length);
  packet.link_type = one.link_type;
  packet.is_big_endian = is_big_endian_;
  interface_name_ = one.name.empty() && interfaces_.size() > 1 ? fmt::format("{}", interface) : one.name;
  packet.interface = interface_name_;
  return true;
}

bool CaptureFile::read_packet(CapturedPacket& packet) {
  if (block_.type == simple_packet) {
    if (block_.length < 4) return fail("a packet that is longer than its block");
    auto length = static_cast<std::size_t>(number(0, 4));
    if (!interfaces_.empty() && interfaces_.front().max_length != 0) {
      length = std::min<std::size_t>(length, interfaces_.front().max_length);
    }
    return fill(packet, 0, 4, length);
  }
  constexpr std::size_t fixed = 20;
  if (block_.length < fixed) return fail("a packet that is longer than its block");
  const auto interface = static_cast<std::size_t>(number(0, block_.type == old_packet ? 2 : 4));
  if (!fill(packet, interface, fixed, static_cast<std::size_t>(number(12, 4)))) return false;
  const Interface& one = interfaces_[interface];
  constexpr std::int64_t max_offset = std::int64_t{1} << 40;
  const std::int64_t offset = std::clamp(one.offset, -max_offset, max_offset) * 1'000'000;
  packet.microseconds = microseconds_of(number(4, 4) << 32U | number(8, 4), one.per_second) + offset;
  return true;
}

}  // namespace edsc
