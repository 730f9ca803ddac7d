/// A model of an SDO server, written only from CiA 301 (version 4.2.0, 7.2.4): it shares no code with the runtime and
/// does everything in the simplest way. It does not send; it reports whether an answer of the server is right, and
/// follows the answer if the standard allows several. Numbers in comments are clauses of CiA 301.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace model {

using Octets = std::vector<std::uint8_t>;
/// The eight data bytes of an SDO frame.
using Data = std::array<std::uint8_t, 8>;
using Answers = std::span<const Data>;

enum class Type { boolean, unsigned_integer, signed_integer, real32, string, domain };

struct Entry {
  std::uint16_t index = 0;
  std::uint8_t sub_index = 0;
  Type type{};
  bool readable = false;
  bool writable = false;
  std::size_t size = 0;  ///< bytes; maximum of a string or DOMAIN
  std::optional<double> low{};
  std::optional<double> high{};
  Octets value{};

  [[nodiscard]] bool variable() const { return type == Type::string || type == Type::domain; }
};

/// The abort codes of table 22.
using Code = std::uint32_t;
constexpr Code toggle_bit = 0x0503'0000;
constexpr Code timeout = 0x0504'0000;
constexpr Code command_specifier = 0x0504'0001;
constexpr Code block_size = 0x0504'0002;
constexpr Code sequence_number = 0x0504'0003;
constexpr Code crc_error = 0x0504'0004;
constexpr Code write_only = 0x0601'0001;
constexpr Code read_only = 0x0601'0002;
constexpr Code no_object = 0x0602'0000;
constexpr Code length_mismatch = 0x0607'0010;
constexpr Code too_long = 0x0607'0012;
constexpr Code too_short = 0x0607'0013;
constexpr Code no_sub_index = 0x0609'0011;
constexpr Code invalid_value = 0x0609'0030;
constexpr Code value_too_high = 0x0609'0031;
constexpr Code value_too_low = 0x0609'0032;
constexpr Code no_data = 0x0800'0024;

using Codes = std::initializer_list<Code>;

/// CRC of 7.2.4.3.16: x^16 + x^12 + x^5 + 1, initial value 0, bit by bit.
inline std::uint16_t crc_of(const Octets& bytes) {
  unsigned crc = 0;
  for (const std::uint8_t byte : bytes) {
    for (int bit = 7; bit >= 0; --bit) {
      const bool carry = ((crc >> 15 & 1u) ^ (byte >> bit & 1u)) != 0;
      crc = (crc << 1 & 0xFFFF) ^ (carry ? 0x1021u : 0u);
    }
  }
  return static_cast<std::uint16_t>(crc);
}

class SdoServer {
 public:
  enum class Phase {
    idle,
    download,                ///< segments of a download
    upload,                  ///< segments of an upload
    block_download,          ///< a sub-block of a block download
    block_download_end,      ///< the last segment has been confirmed
    block_upload_initiated,  ///< the client must start
    block_upload_sent,       ///< a sub-block has been sent and not yet confirmed
    block_upload_end,        ///< the end has been sent and not yet answered
  };

  explicit SdoServer(std::vector<Entry> entries) : entries_{std::move(entries)} {}

  /// Processes a request and the server's answer. Returns null if the answer is right, otherwise what is wrong.
  const char* request(const Data& request, Answers answers) {
    q_ = &request;
    answers_ = answers;
    written_ = nullptr;
    spoilt_ = nullptr;
    const char* const wrong = handle();
    if (is_download() && entry_->type == Type::domain) spoilt_ = entry_;
    return wrong;
  }

  /// The client is silent; `answers` is what the server sends in the time after that. For time-outs the standard only
  /// defines the abort code (0504 0000h), which ends the transfer. A server may confirm an incomplete sub-block before
  /// it aborts: this tells the client what to repeat.
  const char* time_out(Answers answers) {
    answers_ = answers;
    written_ = nullptr;
    spoilt_ = nullptr;
    if (phase_ == Phase::idle) return answers.empty() ? nullptr : "an idle server is silent";
    if (phase_ == Phase::block_download && in_order_ != 0 && answers.size() == 2) {
      const Data& confirmation = answers[0];
      if (confirmation != Data{0xA2, static_cast<std::uint8_t>(in_order_), confirmation[2]})
        return "the confirmation of a sub-block whose end is missing";
      answers_ = answers.last(1);
    }
    return aborts({timeout}, "0504 0000h: the client is silent");
  }

  [[nodiscard]] Phase phase() const { return phase_; }
  [[nodiscard]] std::vector<Entry>& entries() { return entries_; }
  /// The entry to which the last request wrote a new value.
  [[nodiscard]] const Entry* written() const { return written_; }
  /// The DOMAIN whose value is undefined: during a download, and after an incomplete one.
  [[nodiscard]] Entry* spoilt() const { return spoilt_; }

  /// Possible next requests of a correct client and of a client that loses frames.
  [[nodiscard]] std::vector<Data> suggestions() const;

  /// The state without details that do not affect the protocol.
  [[nodiscard]] std::string key() const;

 private:
  [[nodiscard]] bool is_download() const {
    return phase_ == Phase::download || phase_ == Phase::block_download || phase_ == Phase::block_download_end;
  }

  const char* handle() {
    // In a sub-block each frame is a segment. Sequence numbers are 1..127 (7.2.4.3.10), so that 80h is the abort.
    if (phase_ == Phase::block_download && q()[0] != 0x80) return block_download_segment();
    switch (q()[0] >> 5) {
      case 0: return download_segment();
      case 1: return initiate_download();
      case 2: return initiate_upload();
      case 3: return upload_segment();
      case 4:  // abort transfer (7.2.4.3.17): unconfirmed
        leave();
        return answers_.empty() ? nullptr : "an abort is not answered";
      case 5: return block_upload();
      case 6: return block_download();
      default: return unknown_command();
    }
  }

  // ---- the server's answer

  [[nodiscard]] const Data& q() const { return *q_; }

  const char* expect(const Data& frame, const char* message) {
    return answers_.size() == 1 && answers_[0] == frame ? nullptr : message;
  }

  [[nodiscard]] bool answers_abort() const { return answers_.size() == 1 && answers_[0][0] == 0x80; }

  [[nodiscard]] static std::uint32_t word(const Data& data) {
    std::uint32_t value = 0;
    for (unsigned i = 0; i < 4; ++i) value |= static_cast<std::uint32_t>(data[4 + i]) << 8 * i;
    return value;
  }
  static void put_word(Data& data, std::uint32_t value) {
    for (unsigned i = 0; i < 4; ++i) data[4 + i] = static_cast<std::uint8_t>(value >> 8 * i);
  }
  /// A frame with the multiplexer of the current or new transfer.
  [[nodiscard]] Data frame(unsigned command, std::uint32_t value = 0) const {
    Data data{static_cast<std::uint8_t>(command), multiplexer_[0], multiplexer_[1], multiplexer_[2]};
    put_word(data, value);
    return data;
  }

  /// The server aborts the transfer with one of these codes.
  const char* aborts(Codes codes, const char* message) {
    const std::array<std::uint8_t, 3> multiplexer = multiplexer_;
    leave();
    if (!answers_abort()) return message;
    const Data& abort = answers_[0];
    if (!std::equal(multiplexer.begin(), multiplexer.end(), abort.begin() + 1)) return "an abort names its transfer";
    if (std::find(codes.begin(), codes.end(), word(abort)) == codes.end()) return message;
    return nullptr;
  }

  /// A command that does not exist, or not in this state: 0504 0001h. Without a transfer the standard does not specify
  /// the multiplexer of the abort: bytes 1 to 3 of the request, that of the last transfer, or zeros.
  const char* unknown_command() {
    if (phase_ != Phase::idle) return aborts({command_specifier}, "0504 0001h: a command that does not fit the state");
    if (!answers_abort() || word(answers_[0]) != command_specifier) return "0504 0001h: a command without a transfer";
    const bool echoed = std::equal(q().begin() + 1, q().begin() + 4, answers_[0].begin() + 1);
    const bool zero = answers_[0][1] == 0 && answers_[0][2] == 0 && answers_[0][3] == 0;
    const bool last = std::equal(multiplexer_.begin(), multiplexer_.end(), answers_[0].begin() + 1);
    std::copy_n(answers_[0].begin() + 1, 3, multiplexer_.begin());
    return echoed || zero || last ? nullptr : "the multiplexer of an abort without a transfer";
  }

  void leave() {
    if (is_download() && entry_->type == Type::domain) spoilt_ = entry_;
    phase_ = Phase::idle;
    taken_.clear();
  }

  // ---- objects

  /// Begins a transfer with the request's multiplexer. An initiate ends a running transfer, because the client has
  /// abandoned it (the standard has no state in which a server ignores an initiate).
  void begin() {
    leave();
    std::copy_n(q().begin() + 1, 3, multiplexer_.begin());
    entry_ = nullptr;
    bool object = false;
    for (Entry& entry : entries_) {
      if (entry.index != (q()[1] | q()[2] << 8)) continue;
      object = true;
      if (entry.sub_index == q()[3]) entry_ = &entry;
    }
    missing_ = object ? no_sub_index : no_object;
  }

  /// Returns why a value of this length is rejected, or 0.
  [[nodiscard]] std::uint32_t length_error(std::size_t length) const {
    if (length > entry_->size) return too_long;
    if (length < entry_->size && !entry_->variable()) return too_short;
    return 0;
  }

  [[nodiscard]] static double number(const Entry& entry, const Octets& bytes) {
    if (entry.type == Type::real32) {
      float real = 0;
      std::memcpy(&real, bytes.data(), 4);
      return static_cast<double>(real);
    }
    double value = 0;
    for (std::size_t i = bytes.size(); i > 0; --i) value = value * 256 + bytes[i - 1];
    if (entry.type == Type::signed_integer && bytes.back() >= 0x80) value -= std::pow(256.0, double(bytes.size()));
    return value;
  }

  /// Returns whether there are more bytes than announced, or than the entry can hold. A server may report this
  /// immediately or at the end; the standard allows both.
  [[nodiscard]] bool too_many(std::size_t bytes) const {
    return bytes > std::min<std::size_t>(entry_->size, announced_.value_or(0xFFFF'FFFF));
  }

  /// Returns why this value is rejected, or 0.
  [[nodiscard]] std::uint32_t value_error(const Octets& bytes) const {
    if (const std::uint32_t code = length_error(bytes.size()); code != 0) return code;
    if (entry_->variable()) return 0;
    const double value = number(*entry_, bytes);
    if (entry_->type == Type::real32 && std::isnan(value) && (entry_->low || entry_->high)) return invalid_value;
    if (entry_->high && value > *entry_->high) return value_too_high;
    if (entry_->low && value < *entry_->low) return value_too_low;
    return 0;
  }

  void write(const Octets& bytes) {
    entry_->value = bytes;
    written_ = entry_;
  }

  /// Accepts a complete value: the answer is this frame, or an abort.
  const char* take(const Octets& bytes, const Data& answer, const char* message) {
    // A BOOLEAN is one bit (7.1.4.2) in a byte of SDO. The standard does not specify the values 2..255: they are
    // rejected as invalid or taken as TRUE.
    if (entry_->type == Type::boolean && bytes.size() == 1 && bytes[0] > 1) {
      if (answers_abort()) return aborts({invalid_value, value_too_high}, "a BOOLEAN above 1");
      write({1});
      finish();
      return expect(answer, message);
    }
    if (const std::uint32_t code = value_error(bytes); code != 0) return aborts({code}, "a value that is not taken");
    write(bytes);
    finish();
    return expect(answer, message);
  }

  /// Ends the transfer successfully.
  void finish() {
    taken_.clear();
    phase_ = Phase::idle;
  }

  // ---- download (7.2.4.3.3, 7.2.4.3.4)

  const char* initiate_download() {
    begin();
    if (entry_ == nullptr) return aborts({missing_}, "no such object or sub-index");
    if (!entry_->writable) return aborts({read_only}, "0601 0002h: a read-only object is written");
    const bool expedited = (q()[0] & 2) != 0;
    const bool size_indicated = (q()[0] & 1) != 0;
    if (expedited) {
      // Without an indicated size the data have the length of the object, four bytes at most.
      const std::size_t length = size_indicated ? 4u - (q()[0] >> 2 & 3u) : std::min<std::size_t>(entry_->size, 4);
      return take(Octets(q().begin() + 4, q().begin() + 4 + static_cast<int>(length)), frame(0x60),
                  "a download is confirmed: 60h");
    }
    announced_.reset();
    if (size_indicated) {
      announced_ = word(q());
      if (const std::uint32_t code = length_error(*announced_); code != 0)
        return aborts({code}, "the length does not fit");
    }
    phase_ = Phase::download;
    toggle_ = 0;
    return expect(frame(0x60), "a segmented download is confirmed: 60h");
  }

  const char* download_segment() {
    if (phase_ != Phase::download) return unknown_command();
    if ((q()[0] & 0x10) != toggle_) return aborts({toggle_bit}, "0503 0000h: the toggle bit has not alternated");
    taken_.insert(taken_.end(), q().begin() + 1, q().begin() + 8 - (q()[0] >> 1 & 7));
    if (too_many(taken_.size()) && answers_abort()) return aborts({too_long, length_mismatch}, "too many bytes");
    const Data confirmation{static_cast<std::uint8_t>(0x20 | toggle_)};
    toggle_ ^= 0x10;
    if ((q()[0] & 1) == 0) return expect(confirmation, "a segment is confirmed");
    if (announced_ && taken_.size() != *announced_)
      return aborts({length_mismatch, taken_.size() < *announced_ ? too_short : too_long}, "not what was announced");
    return take(Octets{taken_}, confirmation, "the last segment is confirmed");
  }

  // ---- upload (7.2.4.3.5, 7.2.4.3.6)

  const char* initiate_upload() {
    begin();
    if (entry_ == nullptr) return aborts({missing_}, "no such object or sub-index");
    if (!entry_->readable) return aborts({write_only}, "0601 0001h: a write-only object is read");
    return answer_upload();
  }

  const char* answer_upload() {
    const Octets& value = entry_->value;
    // An expedited upload has at least one byte: an empty value is sent in segments or is "no data available".
    if (value.empty() && answers_abort()) return aborts({no_data}, "0800 0024h: no data");
    if (!value.empty() && value.size() <= 4) {
      Data answer = frame(0x43 | (4u - static_cast<unsigned>(value.size())) << 2);
      std::copy(value.begin(), value.end(), answer.begin() + 4);
      finish();
      return expect(answer, "an expedited upload");
    }
    phase_ = Phase::upload;
    toggle_ = 0;
    position_ = 0;
    return expect(frame(0x41, static_cast<std::uint32_t>(value.size())), "a segmented upload tells its size");
  }

  const char* upload_segment() {
    if (phase_ != Phase::upload) return unknown_command();
    if ((q()[0] & 0x10) != toggle_) return aborts({toggle_bit}, "0503 0000h: the toggle bit has not alternated");
    const std::size_t length = std::min<std::size_t>(7, entry_->value.size() - position_);
    const bool last = position_ + length == entry_->value.size();
    Data answer{static_cast<std::uint8_t>(toggle_ | (7 - length) << 1 | (last ? 1 : 0))};
    copy_value(position_, length, answer);
    position_ += length;
    toggle_ ^= 0x10;
    if (last) finish();
    return expect(answer, "a segment of an upload");
  }

  void copy_value(std::size_t from, std::size_t length, Data& to) const {
    for (std::size_t i = 0; i < length; ++i) to[1 + i] = entry_->value[from + i];
  }

  // ---- block download (7.2.4.3.9 to 7.2.4.3.11)

  const char* block_download() {
    if ((q()[0] & 1) != 0) return block_download_end();
    begin();
    if (entry_ == nullptr) return aborts({missing_}, "no such object or sub-index");
    if (!entry_->writable) return aborts({read_only}, "0601 0002h: a read-only object is written");
    announced_.reset();
    if ((q()[0] & 2) != 0) {
      announced_ = word(q());
      if (const std::uint32_t code = length_error(*announced_); code != 0)
        return aborts({code}, "the length does not fit");
    }
    crc_ = (q()[0] & 4) != 0;
    // The server chooses the segments of a sub-block: 1..127.
    if (answers_.size() != 1 || answers_[0][4] < 1 || answers_[0][4] > 127) return "a block size is 1..127";
    start_sub_block(answers_[0][4]);
    last_arrived_ = false;
    return expect(frame(0xA4, block_size_), "a block download is confirmed: A4h, CRC supported");
  }

  void start_sub_block(std::uint8_t segments) {
    phase_ = Phase::block_download;
    block_size_ = segments;
    in_order_ = 0;
  }

  const char* block_download_segment() {
    const unsigned number = q()[0] & 0x7F;
    // 0 is not a sequence number, and a number above the block size cannot belong to this sub-block.
    if (number == 0 || number > block_size_) return aborts({sequence_number}, "0504 0003h: invalid sequence number");
    const bool last = (q()[0] & 0x80) != 0;
    if (number == in_order_ + 1) {
      ++in_order_;
      taken_.insert(taken_.end(), q().begin() + 1, q().end());
      last_arrived_ = last;
      // The last segment may have up to seven unused bytes.
      if (too_many(taken_.size() - (last ? 7 : 0)) && answers_abort())
        return aborts({too_long, length_mismatch}, "too many bytes");
    }
    // Segments after a gap are ignored; the confirmation at the end of the sub-block requests them again.
    if (!last && number != block_size_) return answers_.empty() ? nullptr : "segments of a sub-block are not answered";
    const unsigned confirmed = in_order_;
    if (answers_.size() != 1 || answers_[0][2] < 1 || answers_[0][2] > 127) return "a block size is 1..127";
    if (last_arrived_) {
      phase_ = Phase::block_download_end;
      block_size_ = answers_[0][2];
    } else {
      start_sub_block(answers_[0][2]);
    }
    return expect(Data{0xA2, static_cast<std::uint8_t>(confirmed), block_size_}, "a sub-block is confirmed");
  }

  const char* block_download_end() {
    if (phase_ != Phase::block_download_end) return unknown_command();
    Octets bytes(taken_.begin(), taken_.end() - (q()[0] >> 2 & 7));
    const bool crc_right = !crc_ || crc_of(bytes) == (q()[1] | q()[2] << 8);
    const std::uint32_t length = length_error(bytes.size());
    Code announced = 0;
    if (announced_ && bytes.size() != *announced_) announced = bytes.size() < *announced_ ? too_short : too_long;
    // If both the CRC and the length are wrong, either code is allowed.
    if (!crc_right && announced != 0) return aborts({crc_error, length_mismatch, announced}, "CRC and length");
    if (!crc_right && length != 0) return aborts({crc_error, length}, "CRC and length");
    if (!crc_right) return aborts({crc_error}, "0504 0004h: the CRC is wrong");
    if (announced != 0) return aborts({length_mismatch, announced}, "another length than announced");
    return take(bytes, Data{0xA1}, "the end of a block download is confirmed");
  }

  // ---- block upload (7.2.4.3.12 to 7.2.4.3.15)

  const char* block_upload() {
    switch (q()[0] & 3) {
      case 0: return initiate_block_upload();
      case 1:
        if (phase_ != Phase::block_upload_end) return unknown_command();
        finish();
        return answers_.empty() ? nullptr : "the client's end is not answered";
      case 2: return confirm_block_upload();
      default:
        if (phase_ != Phase::block_upload_initiated) return unknown_command();
        return expect_sub_block();
    }
  }

  const char* initiate_block_upload() {
    begin();
    const bool size_right = q()[4] >= 1 && q()[4] <= 127;
    if (entry_ == nullptr || !entry_->readable) {
      const std::uint32_t code = entry_ == nullptr ? missing_ : write_only;
      return size_right ? aborts({code}, "what cannot be read") : aborts({code, block_size}, "what cannot be read");
    }
    if (!size_right) return aborts({block_size}, "0504 0002h: the block size is not 1..127");
    // Protocol switch threshold: a normal upload is allowed if the value is not longer. 0: not allowed.
    if (q()[5] != 0 && entry_->value.size() <= q()[5] && answers_.size() == 1 && answers_[0][0] >> 5 == 2)
      return answer_upload();
    if (entry_->value.empty() && answers_abort()) return aborts({no_data}, "0800 0024h: no data");
    crc_ = (q()[0] & 4) != 0;
    block_size_ = q()[4];
    position_ = 0;
    phase_ = Phase::block_upload_initiated;
    return expect(frame(0xC6, static_cast<std::uint32_t>(entry_->value.size())), "a block upload tells its size: C6h");
  }

  /// Expects a sub-block of up to block_size_ segments, starting at position_.
  const char* expect_sub_block() {
    phase_ = Phase::block_upload_sent;
    const std::size_t size = entry_->value.size();
    std::size_t from = position_;
    for (in_order_ = 1;; ++in_order_) {
      const std::size_t length = std::min<std::size_t>(7, size - from);
      const bool last = from + length == size;
      Data segment{static_cast<std::uint8_t>(last ? in_order_ | 0x80 : in_order_)};
      copy_value(from, length, segment);
      if (answers_.size() < in_order_ || answers_[in_order_ - 1] != segment) return "a segment of a block upload";
      from += length;
      last_arrived_ = last;
      if (last || in_order_ == block_size_) break;
    }
    return answers_.size() == in_order_ ? nullptr : "no more segments than the block size";
  }

  const char* confirm_block_upload() {
    if (phase_ != Phase::block_upload_sent) return unknown_command();
    const unsigned confirmed = q()[1];
    const bool size_right = q()[2] >= 1 && q()[2] <= 127;
    if (confirmed > in_order_)
      return size_right ? aborts({sequence_number}, "0504 0003h: more segments confirmed than sent")
                        : aborts({sequence_number, block_size}, "more segments confirmed than sent");
    const std::size_t size = entry_->value.size();
    if (confirmed == in_order_ && last_arrived_) {
      // No sub-block follows: a server may or may not check its size.
      if (!size_right && answers_abort()) return aborts({block_size}, "0504 0002h");
      phase_ = Phase::block_upload_end;
      const std::size_t unused = size == 0 ? 7 : (7 - size % 7) % 7;
      const std::uint16_t crc = crc_ ? crc_of(entry_->value) : std::uint16_t{0};
      return expect(Data{static_cast<std::uint8_t>(0xC1 | unused << 2), static_cast<std::uint8_t>(crc),
                         static_cast<std::uint8_t>(crc >> 8)},
                    "the end of a block upload");
    }
    if (!size_right) return aborts({block_size}, "0504 0002h: the block size is not 1..127");
    block_size_ = q()[2];
    position_ += std::size_t{7} * confirmed;
    return expect_sub_block();
  }

  std::vector<Entry> entries_;
  Phase phase_ = Phase::idle;
  std::array<std::uint8_t, 3> multiplexer_{};
  Entry* entry_ = nullptr;
  std::uint32_t missing_ = 0;
  Octets taken_{};                            ///< of a download
  std::optional<std::uint32_t> announced_{};  ///< length of a download
  std::uint8_t toggle_ = 0;
  std::size_t position_ = 0;  ///< of an upload: bytes that the client has received
  bool crc_ = false;
  std::uint8_t block_size_ = 0;
  unsigned in_order_ = 0;      ///< segments of the sub-block that were received or sent
  bool last_arrived_ = false;  ///< the last segment was among them

  const Data* q_ = nullptr;
  Answers answers_{};
  const Entry* written_ = nullptr;
  Entry* spoilt_ = nullptr;
};

inline std::string SdoServer::key() const {
  if (phase_ == Phase::idle) return "idle";
  const auto part = [](std::size_t position, std::size_t end) {
    return position == 0 ? 'b' : position + 7 >= end ? 'e' : 'm';
  };
  char text[80];
  const std::size_t end = phase_ == Phase::upload || phase_ >= Phase::block_upload_initiated ? entry_->value.size()
                          : announced_                                                       ? *announced_
                                                                                             : entry_->size;
  const bool block = phase_ != Phase::download && phase_ != Phase::upload;
  const unsigned sub_block = !block                         ? 0
                             : in_order_ == 0               ? 1
                             : in_order_ == 1               ? 2
                             : in_order_ + 1 == block_size_ ? 4
                             : in_order_ == block_size_     ? 5
                                                            : 3;
  const std::size_t position =
      phase_ == Phase::upload || phase_ >= Phase::block_upload_initiated ? position_ : taken_.size();
  std::snprintf(text, sizeof text, "%d %04X:%02X t%d %c %c%c%c n%u b%d", static_cast<int>(phase_),
                static_cast<unsigned>(entry_->index), static_cast<unsigned>(entry_->sub_index), toggle_,
                part(position, end), announced_ ? 's' : '-', block && crc_ ? 'c' : '-',
                block && last_arrived_ ? 'l' : '-', sub_block,
                block_size_ == 1     ? 1
                : block_size_ == 127 ? 3
                                     : 2);
  return text;
}

inline std::vector<Data> SdoServer::suggestions() const {
  std::vector<Data> list;
  const auto add = [&list](Data data) { list.push_back(data); };
  const auto byte = [](std::size_t value) { return static_cast<std::uint8_t>(value); };
  const Data content{0, 'a', 'b', 'c', 'd', 'e', 'f', 'g'};
  const auto content_with = [&](std::size_t command) {
    Data data = content;
    data[0] = byte(command);
    return data;
  };
  switch (phase_) {
    case Phase::idle: break;
    case Phase::download: {
      const std::size_t left =
          announced_.value_or(static_cast<std::uint32_t>(std::min<std::size_t>(entry_->size, 20))) - taken_.size();
      add(left > 7 ? content_with(toggle_) : content_with(toggle_ | (7 - left) << 1 | 1u));
      add(content_with(toggle_ | 5u << 1));
      break;
    }
    case Phase::upload: add({toggle_ == 0 ? byte(0x60) : byte(0x70)}); break;
    case Phase::block_download: {
      add(content_with(in_order_ + 1));
      add(content_with((in_order_ + 1) | 0x80u));
      add(content_with(block_size_));
      add(content_with(block_size_ | 0x80u));
      break;
    }
    case Phase::block_download_end:
      for (std::size_t unused = 0; unused < 8; ++unused) {
        Octets bytes(taken_.begin(), taken_.end() - static_cast<int>(unused));
        const std::uint16_t crc = crc_of(bytes);
        add({byte(0xC1 | unused << 2), byte(crc), byte(crc >> 8)});
      }
      break;
    case Phase::block_upload_initiated: add({0xA3}); break;
    case Phase::block_upload_sent:
      for (const unsigned size : {1u, 3u, 127u}) {
        add({0xA2, byte(in_order_), byte(size)});
        add({0xA2, byte(in_order_ - 1), byte(size)});
        add({0xA2, 0, byte(size)});
      }
      break;
    case Phase::block_upload_end: add({0xA1}); break;
  }
  return list;
}

}  // namespace model
