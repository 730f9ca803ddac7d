/// A model of an SDO server, written only from CiA 301 (version 4.2.0, 7.2.4): it shares no code with the runtime and
/// does everything in the simplest way. It does not send; it reports whether an answer of the server is right, and
/// follows the answer if the standard allows several. Numbers in comments are clauses of CiA 301.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sdo_model_types.hpp"

namespace model {

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

  const char* block_download();
  void start_sub_block(std::uint8_t segments);
  const char* block_download_segment();
  const char* block_download_end();

  // ---- block upload (7.2.4.3.12 to 7.2.4.3.15)

  const char* block_upload();
  const char* initiate_block_upload();
  /// Expects a sub-block of up to block_size_ segments, starting at position_.
  const char* expect_sub_block();
  const char* confirm_block_upload();

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

}  // namespace model
