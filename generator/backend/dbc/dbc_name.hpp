/// Names in a DBC file.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <unordered_set>

namespace edsc {

inline constexpr std::size_t max_dbc_name = 32;
inline constexpr std::size_t max_long_dbc_name = 255;  ///< of the attributes with long names

/// The names in use in one scope: the file for messages, a message for its signals.
class DbcNames {
 public:
  explicit DbcNames(std::size_t longest = max_dbc_name) : longest_{longest} {}

  /// Reserves and returns `wanted`, an identifier, with up to `longest` characters: a longer name is shortened; if it
  /// is taken, its end is replaced by `_2`, `_3`, ...
  [[nodiscard]] std::string take(std::string_view wanted);

 private:
  std::size_t longest_;
  std::unordered_set<std::string> taken_;
};

/// A text in quotes, in code page 1252. Quotes become apostrophes, since the format cannot express them, and control
/// characters blanks.
[[nodiscard]] std::string dbc_string(std::string_view utf8);

}  // namespace edsc
