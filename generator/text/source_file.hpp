/// The text of a file, converted to UTF-8 and split into lines.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace edsc {

/// cp437 means the DOS code pages 437 and 850, which have the same western European letters.
enum class Encoding : std::uint8_t { ascii, utf8, utf16_le, utf16_be, cp1252, cp437 };

[[nodiscard]] std::string_view to_string(Encoding encoding);

/// How the bytes of a file are compressed.
enum class Packing : std::uint8_t { none, gzip };

class SourceFile {
 public:
  static constexpr std::size_t max_bytes = std::size_t{1} << 30;
  static constexpr std::size_t max_unpacked_bytes = std::size_t{1} << 26;  ///< of a gzip file

  /// `name` is the file name in diagnostics; `bytes` are decoded immediately, without the byte order mark. Undefined
  /// characters of the encoding become U+FFFD. Throws std::length_error above `max_bytes`. `packing` is that of the
  /// file; `bytes` are its unpacked contents.
  SourceFile(std::string name, std::string bytes, Packing packing = Packing::none);

  SourceFile(const SourceFile&) = delete;
  SourceFile& operator=(const SourceFile&) = delete;

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::string_view text() const { return text_; }
  [[nodiscard]] Encoding encoding() const { return encoding_; }
  [[nodiscard]] Packing packing() const { return packing_; }
  /// Whether `text()` is the file byte for byte: ASCII or UTF-8, without byte order mark, not packed.
  [[nodiscard]] bool is_verbatim() const { return is_verbatim_; }
  /// Number of lines; text after the last line end counts if it is not empty.
  [[nodiscard]] std::uint32_t lines() const;
  /// Line `number` (from 1) without its line end (LF, CR LF or CR); empty if it does not exist.
  [[nodiscard]] std::string_view line(std::uint32_t number) const;

 private:
  void decode(std::string bytes);
  void find_lines();

  std::string name_;
  std::string text_;
  Encoding encoding_ = Encoding::ascii;
  Packing packing_ = Packing::none;
  bool is_verbatim_ = false;
  std::vector<std::uint32_t> starts_;  ///< start of each line, and the end
};

/// Reads a whole file and unpacks a gzip file; "-" is standard input. Returns null if the file cannot be read (missing,
/// a folder, no permission, too large), with path and reason in `error`.
[[nodiscard]] std::unique_ptr<SourceFile> read_source_file(const std::string& path, std::string& error);

}  // namespace edsc
