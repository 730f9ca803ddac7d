/// The side of an SLCAN adapter, for targets and for hosts that simulate one.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "canopen/base/clock.hpp"
#include "canopen/can/frame.hpp"
#include "canopen/port/slcan_codec.hpp"

namespace canopen {

/// The adapter's side, between a serial line and a CAN controller, or a node in the same device:
///
///     struct Port {
///       void write(std::span<const char>);      // to the serial line
///       bool open(const SlcanChannel&);         // goes on the bus, or rejects the bit rate
///       void close();                           // leaves it
///       bool send(const canopen::Frame&);       // a frame of the host; false: no room
///       std::uint8_t status();                  // slcan::flag, those set since the last call
///     };
class SlcanAdapter {
 public:
  /// `serial_number`: four characters.
  explicit constexpr SlcanAdapter(std::string_view serial_number = "0000") : serial_number_{serial_number} {}

  [[nodiscard]] constexpr bool is_open() const { return open_; }

  /// Processes a character of the serial line, and responds to the line that it ends.
  template <class Port>
  void on_character(char character, Port& port) {
    const std::optional<std::string_view> line = reader_.take(character);
    if (!line || line->empty() || (*line)[0] == slcan::refusal) return;
    if (!serve(*line, port)) port.write({&slcan::refusal, 1});
  }

  /// Passes a frame of the bus to the host, unless the host does not accept it.
  template <class Port>
  void on_frame(const Frame& frame, TimePoint now, Port& port) {
    if (!open_ || !accepts(frame)) return;
    constexpr std::uint32_t minute = 60'000;
    std::optional<std::uint16_t> stamp;
    if (time_stamps_) stamp = static_cast<std::uint16_t>(now.since_start().count() / 1'000 % minute);
    std::array<char, slcan::longest_line> line;
    port.write({line.data(), slcan::encode(frame, line, stamp)});
  }

 private:
  enum When : std::uint8_t { closed = 1, open = 2, always = 3 };

  struct Command {
    char letter;
    std::uint8_t digits;  ///< that follow it
    When when;
  };
  static constexpr Command commands[] = {
      {'S', 1, closed}, {'s', 4, closed}, {'O', 0, closed}, {'L', 0, closed}, {'M', 8, closed}, {'m', 8, closed},
      {'Z', 1, closed}, {'X', 1, closed}, {'C', 0, open},   {'F', 0, open},   {'V', 0, always}, {'N', 0, always},
  };
  static constexpr std::string_view version = "1013";  ///< hardware 1.0, software 1.3

  /// Returns false if the command is rejected.
  template <class Port>
  [[nodiscard]] bool serve(std::string_view line, Port& port) {
    if (const std::optional<Frame> frame = slcan::decode(line)) {
      if (!open_ || channel_.listen_only || !port.send(*frame)) return false;
      answer(frame->extended ? "Z" : "z", port);
      return true;
    }
    for (const Command& command : commands) {
      if (command.letter != line[0]) continue;
      const std::string_view digits{line.data() + 1, line.size() - 1};
      const std::optional<std::uint32_t> number = slcan::hex_number(digits);
      const bool complete = digits.size() == command.digits && (digits.empty() || number);
      if (!complete || (command.when & (open_ ? open : closed)) == 0) return false;
      return carry_out(command.letter, number.value_or(0), port);
    }
    return false;
  }

  template <class Port>
  [[nodiscard]] bool carry_out(char letter, std::uint32_t number, Port& port) {
    std::array<char, 8> text{};
    switch (letter) {
      case 'S':
        if (number >= std::size(slcan::bit_rates)) return false;
        channel_ = {SlcanChannel::Rate::code, static_cast<std::uint16_t>(number), false};
        break;
      case 's': channel_ = {SlcanChannel::Rate::registers, static_cast<std::uint16_t>(number), false}; break;
      case 'O':
      case 'L':
        channel_.listen_only = letter == 'L';
        open_ = port.open(channel_);
        if (!open_) return false;
        break;
      case 'C':
        open_ = false;
        port.close();
        break;
      case 'M': acceptance_code_ = number; break;
      case 'm': acceptance_mask_ = number; break;
      case 'Z':
        if (number > 1) return false;
        time_stamps_ = number == 1;
        break;
      case 'X': return number <= 1 && answer("", port);  // frames are never polled
      case 'F':
        text[0] = 'F';
        slcan::put_hex(&text[1], port.status(), 2);
        return answer({text.data(), 3}, port);
      case 'V': return answer("V", version, port);
      case 'N': return answer("N", serial_number_, port);
      default: return false;
    }
    return answer("", port);
  }

  template <class Port>
  static bool answer(std::string_view text, Port& port) {
    return answer(text, "", port);
  }
  template <class Port>
  static bool answer(std::string_view text, std::string_view more, Port& port) {
    std::array<char, 12> line;
    std::size_t size = 0;
    for (const std::string_view part : {text, more}) {
      for (std::size_t i = 0; i < part.size() && size + 1 < line.size(); ++i) line[size++] = part[i];
    }
    line[size++] = slcan::end;
    port.write({line.data(), size});
    return true;
  }

  /// Whether a frame passes the two filters of code and mask in the controllers of such adapters (SJA1000, dual
  /// filter mode): 16 bits each, from the left the identifier, followed by the remote bit if it has 11 bits. A 1 in
  /// the mask: any.
  [[nodiscard]] constexpr bool accepts(const Frame& frame) const {
    const std::uint32_t base = (frame.id << 5) | (frame.remote ? 0x10u : 0u);
    const std::uint32_t bits = frame.extended ? frame.id >> 13 : base;
    const std::uint32_t counting = frame.extended ? 0xFFFF : 0xFFF0;  // data of base frames are not compared
    for (const unsigned shift : {16u, 0u}) {
      const std::uint32_t fixed = ~(acceptance_mask_ >> shift) & counting;
      if (((bits ^ (acceptance_code_ >> shift)) & fixed) == 0) return true;
    }
    return false;
  }

  slcan::LineReader reader_;
  std::string_view serial_number_;
  SlcanChannel channel_;
  std::uint32_t acceptance_code_ = 0;
  std::uint32_t acceptance_mask_ = 0xFFFF'FFFF;
  bool open_ = false;
  bool time_stamps_ = false;
};

}  // namespace canopen
