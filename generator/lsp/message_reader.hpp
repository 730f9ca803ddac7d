/// Messages of the Language Server Protocol in a stream of bytes: a header with the length, then JSON.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace edsc::lsp {

class MessageReader {
 public:
  static constexpr std::size_t max_header_bytes = 4096;
  static constexpr std::size_t max_message_bytes = std::size_t{1} << 28;

  void add(std::string_view bytes) { pending_ += bytes; }

  /// The next message without its header; nothing if its bytes are not complete. A header that cannot be read, and a
  /// message that is too long, are skipped.
  [[nodiscard]] std::optional<std::string> next();

  /// What was skipped since the last call; empty if nothing was.
  [[nodiscard]] std::string take_fault();

 private:
  /// Returns false if the end of the header is missing.
  bool read_header();
  void skip_header(std::size_t bytes, std::string_view fault);

  std::string pending_;
  std::size_t begin_ = 0;  ///< of what was not read yet
  std::optional<std::size_t> length_;
  std::size_t skipped_ = 0;  ///< bytes still to skip
  std::string fault_;
};

/// A message with its header.
[[nodiscard]] std::string framed(std::string_view message);

}  // namespace edsc::lsp
