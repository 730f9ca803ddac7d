#include "backend/dbc/read_dbc.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <utility>

namespace edsc {
namespace {

constexpr std::uint32_t extended_bit = 0x8000'0000;     ///< in the number of a message
constexpr std::uint32_t no_message = 0xC000'0000;       ///< holds signals without a message
constexpr std::uint32_t max_extended_id = 0x1FFF'FFFF;  ///< 29 bits
constexpr unsigned bits_of_a_byte = 8;
constexpr unsigned max_bit = 511;  ///< of CAN FD

/// The words of a line, one after the other.
class LineWords {
 public:
  explicit LineWords(std::string_view line) : rest_{line} {}

  /// Characters up to a blank or one of `ends`, without blanks before them.
  std::string_view word(std::string_view ends = {}) {
    skip_blanks();
    std::size_t length = 0;
    while (length < rest_.size() && !is_blank(rest_[length]) && ends.find(rest_[length]) == std::string_view::npos) {
      ++length;
    }
    const std::string_view word = rest_.substr(0, length);
    rest_.remove_prefix(length);
    return word;
  }

  bool skip(char c) {
    skip_blanks();
    if (rest_.empty() || rest_.front() != c) return false;
    rest_.remove_prefix(1);
    return true;
  }

  std::optional<std::uint32_t> number() {
    skip_blanks();
    std::uint32_t value = 0;
    const char* const end = rest_.data() + rest_.size();
    const auto [stop, error] = std::from_chars(rest_.data(), end, value);
    if (error != std::errc{}) return std::nullopt;
    rest_.remove_prefix(static_cast<std::size_t>(stop - rest_.data()));
    return value;
  }

  /// The text between quotes; nothing if the line does not continue with one.
  std::optional<std::string_view> quoted() {
    if (!skip('"')) return std::nullopt;
    const std::size_t end = rest_.find('"');
    if (end == std::string_view::npos) return std::nullopt;
    const std::string_view text = rest_.substr(0, end);
    rest_.remove_prefix(end + 1);
    return text;
  }

 private:
  static bool is_blank(char c) { return c == ' ' || c == '\t'; }
  void skip_blanks() {
    while (!rest_.empty() && is_blank(rest_.front())) rest_.remove_prefix(1);
  }

  std::string_view rest_;
};

class DbcReader {
 public:
  DbcReader(const SourceFile& source, Diagnostics& diagnostics) : source_{source}, diagnostics_{diagnostics} {}

  std::vector<DbcFileMessage> read() {
    bool in_text = false;
    for (std::uint32_t number = 1; number <= source_.lines(); ++number) {
      const std::string_view line = source_.line(number);
      if (!in_text) read_line(line, Position{&source_, number, 1});
      if (std::ranges::count(line, '"') % 2 != 0) in_text = !in_text;
    }
    if (messages_.empty()) {
      diagnostics_.error("network-file", Position{&source_}, "a DBC file has messages, lines that begin with BO_");
    }
    return std::move(messages_);
  }

 private:
  void read_line(std::string_view line, const Position& position) {
    LineWords words{line};
    const std::string_view keyword = words.word();
    if (keyword == "BO_") {
      read_message(words, position);
    } else if (keyword == "SG_") {
      if (in_message_) read_signal(words, position);
    } else if (keyword == "BA_") {
      read_attribute(words);
    }
  }

  /// ` 385 axis1_tpdo_1: 4 axis1`
  void read_message(LineWords& words, const Position& position) {
    in_message_ = false;
    const auto id = words.number();
    const std::string_view name = words.word(":");
    const bool is_valid = id && !name.empty() && words.skip(':') && words.number();
    if (id == no_message) return;
    if (!is_valid || (*id & ~extended_bit) > max_extended_id) return report(position, "message");
    messages_.push_back({std::string{name}, *id & ~extended_bit, (*id & extended_bit) != 0, position, {}});
    in_message_ = true;
  }

  /// ` position : 0|32@1- (1,0) [0|0] "inc" controller`; before the colon `M`, `m2` or `m2M` of multiplexed signals.
  void read_signal(LineWords& words, const Position& position) {
    const std::string_view name = words.word(":");
    const std::string_view multiplexed = words.word(":");
    const bool has_colon = words.skip(':');
    const auto start = words.number();
    const bool has_bar = words.skip('|');
    const auto bits = words.number();
    const bool has_at = words.skip('@');
    const auto order = words.number();
    const bool is_valid = !name.empty() && has_colon && start && has_bar && bits && has_at && order && *order <= 1 &&
                          *start <= max_bit && *bits != 0 && *bits <= max_bit + 1;
    if (!is_valid) return report(position, "signal");
    DbcFileSignal signal{std::string{name}, *start, *bits, multiplexed.empty(), position};
    if (*order == 0) place_big_endian(signal);
    messages_.back().signals.push_back(std::move(signal));
  }

  /// The start of a big-endian signal is its highest bit. In one byte, the order of the bytes does not matter.
  static void place_big_endian(DbcFileSignal& signal) {
    if (signal.bits <= signal.first_bit % bits_of_a_byte + 1) {
      signal.first_bit -= signal.bits - 1;
    } else {
      signal.has_pdo_layout = false;
    }
  }

  /// ` "SystemSignalLongSymbol" SG_ 385 short_name "the_long_name";`
  void read_attribute(LineWords& words) {
    const auto attribute = words.quoted();
    if (attribute != "SystemSignalLongSymbol" || words.word() != "SG_") return;
    const auto id = words.number();
    const std::string_view name = words.word();
    const auto long_name = words.quoted();
    if (!id || !long_name) return;
    for (DbcFileMessage& message : messages_) {
      if ((message.can_id | (message.extended ? extended_bit : 0)) != *id) continue;
      for (DbcFileSignal& signal : message.signals) {
        if (signal.name == name) signal.name = std::string{*long_name};
      }
    }
  }

  void report(const Position& position, std::string_view what) {
    diagnostics_.warning("network-signal", position, fmt::format("this line of the DBC file is not a {}", what));
  }

  const SourceFile& source_;
  Diagnostics& diagnostics_;
  std::vector<DbcFileMessage> messages_;
  bool in_message_ = false;
};

}  // namespace

std::vector<DbcFileMessage> read_dbc(const SourceFile& source, Diagnostics& diagnostics) {
  return DbcReader{source, diagnostics}.read();
}

}  // namespace edsc
