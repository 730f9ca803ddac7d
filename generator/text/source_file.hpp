/// A file's text in UTF-8, whatever it was written in, cut into lines.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace edsc {

/// cp437 stands for the DOS code pages 437 and 850, which agree on the letters of western Europe.
enum class Encoding : std::uint8_t { ascii, utf8, utf16_le, utf16_be, cp1252, cp437 };

[[nodiscard]] std::string_view to_string(Encoding encoding);

class SourceFile {
 public:
  static constexpr std::size_t max_bytes = std::size_t{1} << 30;
  static constexpr std::size_t max_unpacked_bytes = std::size_t{1} << 26;  ///< of a gzip file

  /// `name` is what diagnostics show; `bytes` are decoded at once, a byte order mark is dropped. What the encoding does
  /// not define becomes U+FFFD. More than `max_bytes` throw std::length_error.
  SourceFile(std::string name, std::string bytes);

  SourceFile(const SourceFile&) = delete;
  SourceFile& operator=(const SourceFile&) = delete;

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::string_view text() const { return text_; }
  [[nodiscard]] Encoding encoding() const { return encoding_; }
  /// Whether `text()` is the file byte for byte: ASCII or UTF-8, without byte order mark.
  [[nodiscard]] bool is_verbatim() const { return is_verbatim_; }
  /// Number of lines; the text after the last line end counts when it is not empty.
  [[nodiscard]] std::uint32_t lines() const;
  /// Line `number` (from 1) without its line end (LF, CR LF or CR); empty where there is none.
  [[nodiscard]] std::string_view line(std::uint32_t number) const;

 private:
  void decode(std::string bytes);
  void find_lines();

  std::string name_;
  std::string text_;
  Encoding encoding_ = Encoding::ascii;
  bool is_verbatim_ = false;
  std::vector<std::uint32_t> starts_;  ///< where each line begins; one more for the end
};

/// Reads a whole file, "-" is standard input; one that is a gzip file is unpacked. Returns null when it cannot be read (missing, a folder, no permission,
/// too large); `error` then holds a sentence with path and reason.
[[nodiscard]] std::unique_ptr<SourceFile> read_source_file(const std::string& path, std::string& error);

}  // namespace edsc
