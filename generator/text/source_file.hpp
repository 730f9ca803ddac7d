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

class SourceFile;

/// Where a line of a composed text comes from. Columns count from 1, in bytes.
struct LineOrigin {
  const SourceFile* file = nullptr;
  std::uint32_t line = 0;
  std::uint32_t value_column = 0;  ///< in the composed line; 0 if the line is the same in both
  std::uint32_t origin_key_column = 1;
  std::uint32_t origin_value_column = 1;
};

/// A line of a composed text, without its line end.
struct ComposedLine {
  std::string_view text;
  std::string_view end;  ///< LF, CR LF or CR; empty for a last line without it
  LineOrigin origin;
};

class SourceFile {
 public:
  static constexpr std::size_t max_bytes = std::size_t{1} << 30;
  static constexpr std::size_t max_unpacked_bytes = std::size_t{1} << 26;  ///< of a gzip file

  /// `name` is the file name in diagnostics; `bytes` are decoded immediately, without the byte order mark. Undefined
  /// characters of the encoding become U+FFFD. Throws std::length_error above `max_bytes`. `packing` is that of the
  /// file; `bytes` are its unpacked contents.
  SourceFile(std::string name, std::string bytes, Packing packing = Packing::none);

  /// A text composed of lines of other files, which it keeps: `parts` are these files, the last one the file that the
  /// others change.
  SourceFile(std::string name, const std::vector<ComposedLine>& lines,
             std::vector<std::shared_ptr<const SourceFile>> parts);

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
  /// The line end of line `number`: LF, CR LF, CR, or empty.
  [[nodiscard]] std::string_view line_end(std::uint32_t number) const;

  /// Where a line comes from: this file itself if it is not composed.
  [[nodiscard]] LineOrigin origin(std::uint32_t line) const;
  /// The files that a composed text is made of; empty for a file that was read.
  [[nodiscard]] const std::vector<std::shared_ptr<const SourceFile>>& parts() const { return parts_; }
  /// The file that the other parts change; the file itself if it is not composed.
  [[nodiscard]] const SourceFile& base() const { return parts_.empty() ? *this : *parts_.back(); }

 private:
  void decode(std::string bytes);
  void find_lines();

  std::string name_;
  std::string text_;
  Encoding encoding_ = Encoding::ascii;
  Packing packing_ = Packing::none;
  bool is_verbatim_ = false;
  std::vector<std::uint32_t> starts_;  ///< start of each line, and the end
  std::vector<LineOrigin> origins_;    ///< of a composed text, for each line
  std::vector<std::shared_ptr<const SourceFile>> parts_;
};

/// The bytes of a file, unpacked.
struct FileBytes {
  std::string bytes;
  Packing packing = Packing::none;
  std::string error;  ///< path and reason, if the file cannot be read
};
[[nodiscard]] FileBytes read_bytes(const std::string& path);

/// Reads a whole file and unpacks a gzip file; "-" is standard input. Returns null if the file cannot be read (missing,
/// a folder, no permission, too large), with path and reason in `error`.
[[nodiscard]] std::unique_ptr<SourceFile> read_source_file(const std::string& path, std::string& error);

}  // namespace edsc
