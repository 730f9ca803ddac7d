/// Texts in code pages: conversion to UTF-8, and detection.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "text/encoding.hpp"

namespace edsc {

/// A converted text. Undefined bytes are U+FFFD.
struct DecodedText {
  static constexpr std::size_t none = static_cast<std::size_t>(-1);

  std::string text;                   ///< UTF-8
  std::size_t undefined = none;       ///< place of the first undefined byte in the bytes; `none`: all are defined
  std::size_t undefined_text = none;  ///< place of its U+FFFD in `text`

  [[nodiscard]] bool is_valid() const { return undefined == none; }
};

/// Converts bytes of UTF-8, UTF-16 or a code page. With `Encoding::unknown`, each non-ASCII byte is undefined.
[[nodiscard]] DecodedText decode_text(std::string_view bytes, Encoding encoding);

/// The encoding of a text that is not UTF-8: CP1252 or CP437, by the characters that its non-ASCII bytes would be in
/// either, and by their context. `unknown` if the bytes may be an encoding with several bytes for a character, or are
/// not defined.
[[nodiscard]] Encoding detect_code_page(std::string_view bytes);

/// The encodings in which all bytes of a text that is not UTF-8 are defined, the ones with several bytes for a
/// character first. Those of one byte are listed only if there is nothing else, as nearly all bytes are defined in
/// them.
[[nodiscard]] std::vector<Encoding> possible_encodings(std::string_view bytes);

}  // namespace edsc
