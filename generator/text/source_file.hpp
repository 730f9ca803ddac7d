/// The text of a file, converted to UTF-8 and split into lines.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "text/encoding.hpp"
#include "text/reading_choices.hpp"

namespace edsc {

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

/// Lines of another text, with their line ends and origins.
struct LineRange {
  const SourceFile* file = nullptr;
  std::uint32_t first = 0;
  std::uint32_t count = 0;
};

using ComposedPart = std::variant<ComposedLine, LineRange>;

class SourceFile {
 public:
  static constexpr std::size_t max_bytes = std::size_t{1} << 30;
  static constexpr std::size_t max_unpacked_bytes = std::size_t{1} << 26;  ///< of a gzip file
  static constexpr std::size_t byte_count = 8;                             ///< of `undefined_bytes()`

  /// `name` is the file name in diagnostics; `bytes` are decoded immediately, without the byte order mark. Undefined
  /// characters of the encoding become U+FFFD. Throws std::length_error above `max_bytes`. `packing` is that of the
  /// file; `bytes` are its unpacked contents. A byte order mark is stronger than the choice of an encoding.
  SourceFile(std::string name, std::string bytes, Packing packing = Packing::none, const ReadingChoices& choices = {});

  /// A text composed of lines of other files, which it keeps: `parts` are these files, the last one the file that the
  /// others change.
  SourceFile(std::string name, const std::vector<ComposedPart>& lines,
             std::vector<std::shared_ptr<const SourceFile>> parts);

  SourceFile(const SourceFile&) = delete;
  SourceFile& operator=(const SourceFile&) = delete;

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::string_view text() const { return text_; }
  [[nodiscard]] Encoding encoding() const { return encoding_; }
  [[nodiscard]] const ReadingChoices& choices() const { return choices_; }
  [[nodiscard]] Packing packing() const { return packing_; }
  /// Whether the encoding is only the most likely one: another one would be as valid for the bytes.
  [[nodiscard]] bool is_encoding_guessed() const;
  /// The first bytes that the encoding does not define, `byte_count` at most; empty if it defines all.
  [[nodiscard]] const std::string& undefined_bytes() const { return undefined_bytes_; }
  /// The place of their U+FFFD in `text()`.
  [[nodiscard]] std::size_t undefined_place() const { return undefined_place_; }
  /// Encodings that define all bytes, if this one does not.
  [[nodiscard]] const std::vector<Encoding>& possible() const { return possible_; }
  /// Whether `text()` is the file byte for byte: ASCII or UTF-8, without byte order mark, not packed.
  [[nodiscard]] bool is_verbatim() const { return is_verbatim_; }
  /// Number of lines; text after the last line end counts if it is not empty.
  [[nodiscard]] std::uint32_t lines() const { return static_cast<std::uint32_t>(starts_.size() - 1); }
  /// Line `number` (from 1) without its line end (LF, CR LF or CR); empty if it does not exist.
  [[nodiscard]] std::string_view line(std::uint32_t number) const;
  /// The first character of line `number`, which exists, or of its line end; NUL for an empty line without one.
  [[nodiscard]] char first_character(std::uint32_t number) const { return text_[starts_[number - 1]]; }
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
  void convert(std::string_view bytes, Encoding encoding);
  void find_lines();
  [[nodiscard]] static std::string_view text_of(const LineRange& range);

  std::string name_;
  std::string text_;
  Encoding encoding_ = Encoding::ascii;
  Packing packing_ = Packing::none;
  bool is_verbatim_ = false;
  ReadingChoices choices_;
  std::string undefined_bytes_;
  std::size_t undefined_place_ = 0;
  std::vector<Encoding> possible_;
  std::vector<std::uint32_t> starts_;  ///< start of each line, and the end
  std::vector<LineOrigin> origins_;    ///< of a composed text, for each line
  std::vector<std::shared_ptr<const SourceFile>> parts_;
};

/// Names the undefined bytes of a file and the encodings that define all of its bytes:
/// `bytes 8Eh B2h are not ASCII, and the encoding is not known; the text is valid Shift-JIS and GB18030`.
[[nodiscard]] std::string undefined_bytes_text(const SourceFile& source);

/// The bytes of a file, unpacked.
struct FileBytes {
  std::string bytes;
  Packing packing = Packing::none;
  std::string error;  ///< path and reason, if the file cannot be read
};
[[nodiscard]] FileBytes read_bytes(const std::string& path);

/// Reads a whole file and unpacks a gzip file; "-" is standard input. Returns null if the file cannot be read (missing,
/// a folder, no permission, too large), with path and reason in `error`.
[[nodiscard]] std::unique_ptr<SourceFile> read_source_file(const std::string& path, std::string& error,
                                                           const ReadingChoices& choices = {});

}  // namespace edsc
