/// Makes text of files and devices safe for a terminal, a comment or a JSON viewer: control characters and characters
/// that change the text direction become visible, and have no effect.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <string>
#include <string_view>
#include <type_traits>

#include "system/standard_streams.hpp"

namespace edsc {

/// Returns true for a code point that a terminal or editor interprets or hides instead of displaying it: C0 and C1
/// controls, bidirectional marks, line separators and other invisible format characters, except for the joiners of
/// Indic and Persian scripts.
[[nodiscard]] bool is_hidden(char32_t code_point);

/// The UTF-8 sequence that `text` begins with: its length, and whether it can be displayed unchanged. A byte that does
/// not begin a well-formed sequence is a sequence of length 1 that cannot.
struct Sequence {
  std::size_t length = 0;
  bool is_visible = false;
};
[[nodiscard]] Sequence first_sequence(std::string_view text);

/// `text` with hidden code points as `<U+202E>`, bytes that are not UTF-8 as `<9B>`, and a blank for a tab or
/// line end.
[[nodiscard]] std::string printable(std::string_view text);
void append_printable(std::string& out, std::string_view text);

/// Returns the JSON with hidden code points as \u202E. Readers decode it like `json`.
[[nodiscard]] std::string printable_json(std::string json);

/// A value of nlohmann::json as text for people and programs. Bytes that are not UTF-8 become U+FFFD.
template <typename Json>
[[nodiscard]] std::string json_text(const Json& json) {
  return printable_json(json.dump(2, ' ', false, Json::error_handler_t::replace));
}

namespace detail {

template <typename Value>
using Printed = std::conditional_t<std::is_convertible_v<const Value&, std::string_view>, std::string, Value>;

template <typename Value>
Printed<Value> printed(const Value& value) {
  if constexpr (std::is_convertible_v<const Value&, std::string_view>) {
    return printable(value);
  } else {
    return value;
  }
}

}  // namespace detail

/// fmt::print() with each text among `values` made printable: for messages with names, values or paths.
template <typename... Values>
void print_visibly(std::FILE* stream, fmt::format_string<detail::Printed<std::decay_t<Values>>...> format,
                   const Values&... values) {
  fmt::print(stream, format, detail::printed<std::decay_t<Values>>(values)...);
}

/// The same to standard error. A message that cannot be written changes neither the work of a command nor its exit
/// code.
template <typename... Values>
void print_to_stderr(fmt::format_string<detail::Printed<std::decay_t<Values>>...> format, const Values&... values) {
  write_to_stderr(fmt::format(format, detail::printed<std::decay_t<Values>>(values)...));
}

}  // namespace edsc
