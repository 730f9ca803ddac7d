/// Edits of the lines of a text. All other bytes remain: encoding, byte order mark, line ends, blanks and comments.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "text/source_file.hpp"

namespace edsc {

struct NewLine {
  std::string text;  ///< without line end
  LineOrigin origin;
};

/// Replaces `removed` lines from `line` on by `lines`; without removed lines, inserts before `line`, which is one after
/// the last line for the end of the file. A line that replaces another one keeps its line end; further lines take the
/// line end of the line before.
struct TextEdit {
  std::uint32_t line = 0;
  std::uint32_t removed = 0;
  std::vector<NewLine> lines;
};

/// The text with the edits, which are ascending and do not overlap. `changed_by` is the file that the edits come from;
/// its name becomes that of the text.
[[nodiscard]] std::unique_ptr<SourceFile> edited_text(const std::shared_ptr<const SourceFile>& base,
                                                      const std::vector<TextEdit>& edits,
                                                      const std::shared_ptr<const SourceFile>& changed_by);

/// Bytes of a file that others replace.
struct ByteEdit {
  std::size_t offset = 0;  ///< in the file before
  std::string before;
  std::string after;

  friend bool operator==(const ByteEdit&, const ByteEdit&) = default;
};

struct EditedBytes {
  std::string bytes;
  std::vector<ByteEdit> changes;  ///< of the bytes before, ascending
  std::string error;              ///< names a character that the encoding cannot express
};

/// The bytes of a file with the edits. `encoding` is that of the file; an ASCII file becomes UTF-8 with `allow_utf8`.
[[nodiscard]] EditedBytes edited_bytes(std::string_view bytes, Encoding encoding, const std::vector<TextEdit>& edits,
                                       bool allow_utf8);

}  // namespace edsc
