/// A line that simulates an input of a node, such as `digital 1 0x55`: a name and its arguments.
#pragma once

#include <canopen/can/bus_status.hpp>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace nodes {

class InputLine {
 public:
  explicit InputLine(std::string_view line) {
    std::istringstream text{std::string{line}};
    for (std::string word; text >> word;) words_.push_back(std::move(word));
  }

  [[nodiscard]] bool empty() const { return words_.empty(); }
  /// Whether the line begins with this word and has this number of arguments.
  [[nodiscard]] bool is(std::string_view name, std::size_t arguments) const {
    return words_.size() == arguments + 1 && words_[0] == name;
  }
  /// Whether the line begins with this word and has at least this number of arguments.
  [[nodiscard]] bool begins_with(std::string_view name, std::size_t arguments) const {
    return words_.size() > arguments && words_[0] == name;
  }
  /// The rest of the line after `count` words.
  [[nodiscard]] InputLine after(std::size_t count) const {
    InputLine rest{""};
    rest.words_.assign(words_.begin() + static_cast<std::ptrdiff_t>(count), words_.end());
    return rest;
  }
  /// The argument at a position, from 1 on.
  [[nodiscard]] std::string_view word(std::size_t position) const { return words_[position]; }

  /// The argument as an integer, 8976, 0x2310 or 2310h; std::nullopt if it is not an integer or out of range.
  template <class T>
  [[nodiscard]] std::optional<T> number(std::size_t position, T lowest = std::numeric_limits<T>::min(),
                                        T highest = std::numeric_limits<T>::max()) const {
    std::string_view text = words_[position];
    const bool negative = text.starts_with('-');
    if (negative) text.remove_prefix(1);
    const bool prefixed = text.starts_with("0x") || text.starts_with("0X");
    const bool hex = prefixed || text.ends_with('h') || text.ends_with('H');
    if (prefixed) {
      text.remove_prefix(2);
    } else if (hex) {
      text.remove_suffix(1);
    }
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, hex ? 16 : 10);
    if (error != std::errc{} || end != text.data() + text.size() || value < 0) return std::nullopt;
    if (negative) value = -value;
    if (value < std::int64_t{lowest} || value > std::int64_t{highest}) return std::nullopt;
    return static_cast<T>(value);
  }

  /// The argument as a number with a fraction.
  [[nodiscard]] std::optional<double> real(std::size_t position) const {
    const std::string& text = words_[position];
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    return end == text.c_str() + text.size() ? std::optional{value} : std::nullopt;
  }

  /// The argument as `on` or `off`.
  [[nodiscard]] std::optional<bool> on_or_off(std::size_t position) const {
    if (words_[position] == "on") return true;
    if (words_[position] == "off") return false;
    return std::nullopt;
  }

 private:
  std::vector<std::string> words_;
};

/// The status of the CAN controller: `can active`, `can passive`, `can off`, `can overrun`.
[[nodiscard]] inline std::optional<canopen::BusStatus> bus_status_of(const InputLine& line) {
  if (!line.is("can", 1)) return std::nullopt;
  if (line.word(1) == "active") return canopen::BusStatus{};
  if (line.word(1) == "passive") return canopen::BusStatus{canopen::BusState::passive};
  if (line.word(1) == "off") return canopen::BusStatus{canopen::BusState::off};
  if (line.word(1) == "overrun") return canopen::BusStatus{canopen::BusState::active, true};
  return std::nullopt;
}

}  // namespace nodes
