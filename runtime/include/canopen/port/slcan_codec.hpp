/// SLCAN, the ASCII protocol of the Lawicel adapters: CAN frames as lines on a serial line. Both sides, for hosts and
/// targets: no operating system, no heap.
///
///   t12320011<CR>          data frame 123h, 2 bytes 00 11        r1232<CR>       remote frame
///   T123456782AABB<CR>     the same with 29 bits                 R123456782<CR>
///
/// Commands to the adapter: S0..S8 bit rate, sxxyy bit timing registers, O open, L open to listen only, C close,
/// Mxxxxxxxx and mxxxxxxxx acceptance code and mask, Z0 and Z1 time stamps, F status flags, V version, N serial number.
/// The adapter responds with <CR>, or with <BEL> to a command that it rejects.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "canopen/bus_status.hpp"
#include "canopen/frame.hpp"
#include "canopen/time.hpp"

namespace canopen {

namespace slcan {

inline constexpr char end = '\r';
inline constexpr char refusal = '\a';

/// Characters of the longest frame: letter, identifier, length, data, time stamp and end of line.
inline constexpr std::size_t longest_line = 1 + 8 + 1 + 16 + 4 + 1;

/// Bit rates of the commands S0..S8, in bit/s.
inline constexpr std::uint32_t bit_rates[] = {10'000,  20'000,  50'000,  100'000,  125'000,
                                              250'000, 500'000, 800'000, 1'000'000};

/// Returns the digit of the command S for a bit rate; empty if there is none.
[[nodiscard]] constexpr std::optional<std::uint8_t> bit_rate_code(std::uint32_t bit_rate) {
  for (std::size_t i = 0; i < std::size(bit_rates); ++i) {
    if (bit_rates[i] == bit_rate) return static_cast<std::uint8_t>(i);
  }
  return std::nullopt;
}

/// Status flags of the command F.
namespace flag {
inline constexpr std::uint8_t receive_queue_full = 0x01;
inline constexpr std::uint8_t send_queue_full = 0x02;
inline constexpr std::uint8_t error_warning = 0x04;
inline constexpr std::uint8_t data_overrun = 0x08;
inline constexpr std::uint8_t error_passive = 0x20;
inline constexpr std::uint8_t arbitration_lost = 0x40;
inline constexpr std::uint8_t bus_error = 0x80;
}  // namespace flag

/// Returns the value of a hexadecimal digit; 16 for any other character.
[[nodiscard]] constexpr std::uint8_t hex_value(char digit) {
  if (digit >= '0' && digit <= '9') return static_cast<std::uint8_t>(digit - '0');
  if (digit >= 'A' && digit <= 'F') return static_cast<std::uint8_t>(digit - 'A' + 10);
  if (digit >= 'a' && digit <= 'f') return static_cast<std::uint8_t>(digit - 'a' + 10);
  return 16;
}

/// Returns a number of up to eight hexadecimal digits; empty if one of them is not a digit.
[[nodiscard]] constexpr std::optional<std::uint32_t> hex_number(std::string_view digits) {
  std::uint32_t number = 0;
  for (const char digit : digits) {
    const std::uint8_t value = hex_value(digit);
    if (value > 15) return std::nullopt;
    number = (number << 4) | value;
  }
  return digits.empty() || digits.size() > 8 ? std::nullopt : std::optional{number};
}

/// Writes a number with this many hexadecimal digits; returns the position after them.
constexpr char* put_hex(char* to, std::uint32_t number, unsigned digits) {
  for (unsigned i = digits; i-- > 0; ++to) *to = "0123456789ABCDEF"[(number >> (4 * i)) & 0xF];
  return to;
}

/// Writes the line of a frame, including its end, and returns its length. With a time stamp in ms, if given.
[[nodiscard]] constexpr std::size_t encode(const Frame& frame, std::span<char, longest_line> line,
                                           std::optional<std::uint16_t> milliseconds = std::nullopt) {
  char* to = line.data();
  if (frame.remote) {
    *to++ = frame.extended ? 'R' : 'r';
  } else {
    *to++ = frame.extended ? 'T' : 't';
  }
  to = put_hex(to, frame.id, frame.extended ? 8 : 3);
  to = put_hex(to, frame.size, 1);
  for (std::uint8_t i = 0; i < frame.size && !frame.remote; ++i) to = put_hex(to, frame.data[i], 2);
  if (milliseconds) to = put_hex(to, *milliseconds, 4);
  *to++ = end;
  return static_cast<std::size_t>(to - line.data());
}

/// Returns the frame of a line without its end; empty if it is not one. A time stamp after it is ignored.
[[nodiscard]] constexpr std::optional<Frame> decode(std::string_view line) {
  if (line.empty()) return std::nullopt;
  Frame frame{};
  switch (line[0]) {
    case 't': break;
    case 'r': frame.remote = true; break;
    case 'T': frame.extended = true; break;
    case 'R': frame.extended = frame.remote = true; break;
    default: return std::nullopt;
  }
  const std::size_t digits = frame.extended ? 8 : 3;
  if (line.size() < 1 + digits + 1) return std::nullopt;
  const std::optional<std::uint32_t> id = hex_number({line.data() + 1, digits});
  const std::uint8_t size = hex_value(line[1 + digits]);
  if (!id || *id > (frame.extended ? 0x1FFF'FFFFu : 0x7FFu) || size > 8) return std::nullopt;
  frame.id = *id;
  frame.size = size;
  line.remove_prefix(1 + digits + 1);
  for (std::uint8_t i = 0; i < size && !frame.remote; ++i) {
    const std::optional<std::uint32_t> byte = line.size() >= 2 ? hex_number({line.data(), 2}) : std::nullopt;
    if (!byte) return std::nullopt;
    frame.data[i] = static_cast<std::uint8_t>(*byte);
    line.remove_prefix(2);
  }
  const bool time_stamp = line.size() == 4 && hex_number(line).has_value();
  return line.empty() || time_stamp ? std::optional{frame} : std::nullopt;
}

/// Assembles characters to lines. Characters that are not letters or digits discard what precedes them; of a line that
/// is longer than any frame, the beginning is kept, which is not a valid frame.
class LineReader {
 public:
  /// Returns the line that this character ends, without it; valid until the next call. A <BEL> is a line of its own.
  [[nodiscard]] std::optional<std::string_view> take(char character) {
    if (character == end || character == refusal) {
      const std::string_view line{text_.data(), size_};
      size_ = 0;
      if (character == end) return line;
      return std::string_view{&refusal, 1};
    }
    const char letter = static_cast<char>(character | 0x20);
    const bool known = (character >= '0' && character <= '9') || (letter >= 'a' && letter <= 'z');
    if (!known) {
      size_ = 0;
    } else if (size_ < text_.size()) {
      text_[size_++] = character;
    }
    return std::nullopt;
  }

 private:
  std::array<char, longest_line> text_{};
  std::uint8_t size_ = 0;
};

}  // namespace slcan

/// The channel settings of a host.
struct SlcanChannel {
  enum class Rate : std::uint8_t { unspecified, code, registers };

  Rate rate = Rate::unspecified;
  std::uint16_t value =
      0;  ///< of `code` 0..8, see slcan::bit_rates; of `registers` BTR0 in the high and BTR1 in the low byte
  bool listen_only = false;

  friend constexpr bool operator==(const SlcanChannel&, const SlcanChannel&) = default;
};

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

/// The host's side: opens the channel of an adapter, and converts its lines to frames. `output` is what it needs to
/// write; frames are encoded with `encode`.
class SlcanHost {
 public:
  enum class State : std::uint8_t { connecting, open, refused };
  static constexpr std::size_t longest_message = slcan::longest_line;
  static constexpr std::string_view farewell = "C\r";

  /// Starts to open the channel. Bit rate code 0..8; empty: set in the adapter. A missing response is ignored after
  /// half a second, because some adapters do not send any.
  void start(std::optional<std::uint8_t> bit_rate_code, TimePoint now) {
    bit_rate_code_ = bit_rate_code;
    put("\r\r\rC\r");  // ends an unfinished command and an open channel
    enter(Step::closing, now + settling);
  }

  [[nodiscard]] State state() const {
    if (step_ == Step::open) return State::open;
    return step_ == Step::refused ? State::refused : State::connecting;
  }

  /// Returns why the channel was rejected.
  [[nodiscard]] std::string_view problem() const { return problem_; }

  /// Returns the status that the adapter reports.
  [[nodiscard]] BusStatus status() const { return status_; }

  /// Processes a character of the adapter; returns the frame that it ends, if any.
  [[nodiscard]] std::optional<Frame> on_character(char character, TimePoint now) {
    const std::optional<std::string_view> line = reader_.take(character);
    if (!line) return std::nullopt;
    switch (step_) {
      case Step::closing:
      case Step::refused: return std::nullopt;
      case Step::setting:
      case Step::opening:
        if (line->empty()) next_step(now);
        if (!line->empty() && (*line)[0] == slcan::refusal) refuse(now);
        return std::nullopt;
      case Step::open: break;
    }
    if (!line->empty() && ((*line)[0] == slcan::refusal || (*line)[0] == 'F')) {
      on_status(*line, now);
      return std::nullopt;
    }
    return slcan::decode(*line);
  }

  void on_time(TimePoint now) {
    if (!deadline_ || now < *deadline_) return;
    if (step_ != Step::open) return next_step(now);
    if (asked_) return forget_flags();
    put("F\r");
    asked_ = true;
    deadline_ = now + response_timeout;
  }

  [[nodiscard]] std::optional<TimePoint> next_deadline() const { return deadline_; }

  /// Returns what must be written before any frame; call `output_taken` when that has been done.
  [[nodiscard]] std::string_view output() const { return {output_.data(), output_size_}; }
  void output_taken() { output_size_ = 0; }

  [[nodiscard]] static std::size_t encode(const Frame& frame, std::span<char, longest_message> line) {
    return slcan::encode(frame, line);
  }

 private:
  enum class Step : std::uint8_t { closing, setting, opening, open, refused };

  static constexpr Duration settling{100'000};  ///< for data still in transit
  static constexpr Duration response_timeout{500'000};  ///< for a response
  static constexpr Duration between_flags{1'000'000};
  static constexpr std::uint8_t max_refusals = 3;

  void enter(Step step, std::optional<TimePoint> deadline) {
    step_ = step;
    deadline_ = deadline;
  }

  void next_step(TimePoint now) {
    if (step_ == Step::closing && bit_rate_code_) {
      const char command[] = {'S', static_cast<char>('0' + *bit_rate_code_), slcan::end};
      put({command, sizeof command});
      enter(Step::setting, now + response_timeout);
    } else if (step_ == Step::closing || step_ == Step::setting) {
      put("O\r");
      enter(Step::opening, now + response_timeout);
    } else {
      enter(Step::open, std::nullopt);
    }
  }

  /// Handles a rejection. A slow adapter's response to earlier commands may look like one: only the third one
  /// is accepted.
  void refuse(TimePoint now) {
    if (++refusals_ < max_refusals) {
      put("C\r");
      return enter(Step::closing, now + settling);
    }
    problem_ = step_ == Step::setting ? "the adapter refuses the bit rate" : "the adapter does not open its channel";
    enter(Step::refused, std::nullopt);
  }

  /// Handles a rejection, for instance of a frame without room. The flags show the cause, and are read until they
  /// are clear.
  void on_status(std::string_view line, TimePoint now) {
    if (line[0] == slcan::refusal) {
      if (has_flags_ && !asked_) deadline_ = now;
      return;
    }
    const std::optional<std::uint32_t> flags = line.size() == 3 ? slcan::hex_number(line.substr(1)) : std::nullopt;
    if (!flags) return;
    asked_ = false;
    status_.state = (*flags & slcan::flag::error_passive) != 0 ? BusState::passive : BusState::active;
    status_.overrun = (*flags & (slcan::flag::data_overrun | slcan::flag::receive_queue_full)) != 0;
    deadline_.reset();
    if (status_ != BusStatus{}) deadline_ = now + between_flags;
  }

  /// Stops reading the flags of an adapter that does not support them.
  void forget_flags() {
    asked_ = has_flags_ = false;
    deadline_.reset();
    status_ = {};
  }

  void put(std::string_view text) {
    for (const char character : text) {
      if (output_size_ < output_.size()) output_[output_size_++] = character;
    }
  }

  slcan::LineReader reader_;
  std::array<char, 16> output_{};
  std::uint8_t output_size_ = 0;
  Step step_ = Step::closing;
  std::optional<std::uint8_t> bit_rate_code_;
  std::optional<TimePoint> deadline_;
  std::string_view problem_;
  BusStatus status_;
  std::uint8_t refusals_ = 0;
  bool asked_ = false;  ///< the flags have been requested, without a response so far
  bool has_flags_ = true;
};

}  // namespace canopen
