#include "change/text_edit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <utility>

#include "text/code_page.hpp"
#include "text/utf8.hpp"

namespace edsc {
namespace {

constexpr std::uint32_t no_end = 0;
constexpr std::uint32_t default_end = UINT32_MAX;
constexpr std::string_view default_line_end = "\n";

/// Lines of the base, or a new one.
struct PlannedLine {
  std::uint32_t of_base = 0;       ///< the first one; 0 for a new line
  std::uint32_t count = 1;         ///< of lines of the base, which all keep their line ends if there are several
  const NewLine* added = nullptr;  ///< null for lines of the base
  std::uint32_t end_of = no_end;  ///< the line of the base with the line end of the last one, `no_end` or `default_end`
};

class EditPlan {
 public:
  /// `has_last_end`: whether the last line has a line end.
  EditPlan(std::uint32_t lines, bool has_last_end, const std::vector<TextEdit>& edits)
      : lines_(lines), has_last_end_(has_last_end) {
    std::uint32_t next = 1;
    for (const TextEdit& edit : edits) {
      keep(next, edit.line);
      for (std::size_t i = 0; i < edit.lines.size(); ++i) {
        const bool replaces = i < edit.removed;
        plan_.push_back({0, 1, &edit.lines[i],
                         replaces ? end_of(edit.line + static_cast<std::uint32_t>(i)) : end_before(edit.line)});
      }
      next = edit.line + edit.removed;
    }
    keep(next, lines + 1);
    fix_ends();
  }

  [[nodiscard]] const std::vector<PlannedLine>& lines() const { return plan_; }

 private:
  /// The last line is apart, since its line end can change.
  void keep(std::uint32_t first, std::uint32_t end) {
    if (first >= end) return;
    const std::uint32_t last = end - 1;
    if (first < last) plan_.push_back({first, last - first, nullptr, last - 1});
    plan_.push_back({last, 1, nullptr, end_of(last)});
  }

  [[nodiscard]] std::uint32_t end_of(std::uint32_t line) const {
    return line == lines_ && !has_last_end_ ? no_end : line;
  }

  [[nodiscard]] std::uint32_t end_before(std::uint32_t line) const {
    if (lines_ < 2) return lines_ == 1 && has_last_end_ ? 1 : default_end;
    return std::clamp<std::uint32_t>(line - 1, 1, has_last_end_ ? lines_ : lines_ - 1);
  }

  /// Only the last line may be without a line end, and it is if that of the base is.
  void fix_ends() {
    for (std::size_t i = 0; i + 1 < plan_.size(); ++i) {
      if (plan_[i].end_of == no_end) plan_[i].end_of = end_before(lines_);
    }
    if (!plan_.empty() && !has_last_end_ && lines_ > 0) plan_.back().end_of = no_end;
  }

  std::uint32_t lines_;
  bool has_last_end_;
  std::vector<PlannedLine> plan_;
};

struct RawLine {
  std::string_view text;
  std::string_view end;
};

constexpr std::array<std::string_view, 3> byte_order_marks = {"\xEF\xBB\xBF", "\xFF\xFE", "\xFE\xFF"};

bool has_several_bytes(Encoding encoding) {
  return encoding == Encoding::shift_jis || encoding == Encoding::gb18030 || encoding == Encoding::big5 ||
         encoding == Encoding::cp949;
}

bool is_utf16(Encoding encoding) { return encoding == Encoding::utf16_le || encoding == Encoding::utf16_be; }

/// Splits bytes at LF, CR LF and CR, as SourceFile splits their text.
std::vector<RawLine> raw_lines(std::string_view bytes, Encoding encoding) {
  const std::size_t width = is_utf16(encoding) ? 2 : 1;
  const auto unit = [&](std::size_t at) -> unsigned {
    if (at + width > bytes.size()) return 0;
    const auto byte = [&](std::size_t i) { return static_cast<unsigned>(static_cast<unsigned char>(bytes[i])); };
    if (width == 1) return byte(at);
    return encoding == Encoding::utf16_le ? byte(at) | byte(at + 1) << 8U : byte(at) << 8U | byte(at + 1);
  };
  std::vector<RawLine> lines;
  std::size_t start = 0;
  for (std::size_t at = 0; at < bytes.size(); at += width) {
    const unsigned c = unit(at);
    if (c != '\n' && c != '\r') continue;
    const std::size_t end = c == '\r' && unit(at + width) == '\n' ? 2 * width : width;
    lines.push_back({bytes.substr(start, at - start), bytes.substr(at, end)});
    at += end - width;
    start = at + width;
  }
  if (start < bytes.size()) lines.push_back({bytes.substr(start), {}});
  return lines;
}

/// The bytes of a character in a code page, one or two; nothing if it does not have them.
std::optional<std::string> bytes_in(Encoding encoding, std::string_view character) {
  const auto is_character = [&](std::string_view bytes) {
    const DecodedText decoded = decode_text(bytes, encoding);
    return decoded.is_valid() && decoded.text == character;
  };
  for (unsigned first = 0x80; first < 0x100; ++first) {
    std::string bytes(1, static_cast<char>(static_cast<unsigned char>(first)));
    if (is_character(bytes)) return bytes;
    if (!has_several_bytes(encoding)) continue;
    bytes += ' ';
    for (unsigned second = 0x30; second < 0x100; ++second) {
      bytes[1] = static_cast<char>(static_cast<unsigned char>(second));
      if (is_character(bytes)) return bytes;
    }
  }
  return std::nullopt;
}

class TextEncoder {
 public:
  TextEncoder(Encoding encoding, bool allow_utf8) : encoding_(encoding), allow_utf8_(allow_utf8) {}

  void append(std::string& out, std::string_view text) {
    if (encoding_ == Encoding::utf8 || (encoding_ == Encoding::ascii && allow_utf8_)) {
      out += text;
    } else if (is_utf16(encoding_)) {
      const std::string units = to_utf16_bytes(text);
      for (std::size_t at = 0; at < units.size(); at += 2) {
        const bool low_first = encoding_ == Encoding::utf16_le;
        out += units[low_first ? at : at + 1];
        out += units[low_first ? at + 1 : at];
      }
    } else {
      append_bytes(out, text);
    }
  }

  [[nodiscard]] const std::string& error() const { return error_; }

 private:
  void append_bytes(std::string& out, std::string_view text) {
    while (!text.empty()) {
      const std::size_t length = std::max<std::size_t>(utf8_sequence_length(text), 1);
      const std::string_view character = text.substr(0, length);
      text.remove_prefix(length);
      if (is_ascii(character)) {
        out += character;
        continue;
      }
      const bool has_code_page = encoding_ != Encoding::ascii && encoding_ != Encoding::unknown;
      const auto bytes = has_code_page ? bytes_in(encoding_, character) : std::nullopt;
      if (bytes) {
        out += *bytes;
      } else if (error_.empty()) {
        error_ = fmt::format("the encoding of the file, {}, does not have the character {}{}", to_string(encoding_),
                             character, encoding_ == Encoding::ascii ? "; --utf8 writes UTF-8" : "");
      }
    }
  }

  Encoding encoding_;
  bool allow_utf8_;
  std::string error_;
};

/// Collects what is between the kept parts of a file. Parts are kept in their order.
class ByteChanges {
 public:
  /// `after` grows while parts are kept; what it has at first is kept.
  ByteChanges(std::string_view before, const std::string& after)
      : before_(before), after_(after), end_before_(after.size()), end_after_(after.size()) {}

  /// To be called before the part is appended to the file after.
  void keep(std::size_t offset, std::size_t size) {
    add(offset);
    end_before_ = offset + size;
    end_after_ = after_.size() + size;
  }

  [[nodiscard]] std::vector<ByteEdit> finish() {
    add(before_.size());
    return std::move(changes_);
  }

 private:
  void add(std::size_t offset) {
    if (offset == end_before_ && after_.size() == end_after_) return;
    changes_.push_back(
        {end_before_, std::string{before_.substr(end_before_, offset - end_before_)}, after_.substr(end_after_)});
  }

  std::string_view before_;
  const std::string& after_;
  std::size_t end_before_;
  std::size_t end_after_;
  std::vector<ByteEdit> changes_;
};

}  // namespace

std::unique_ptr<SourceFile> edited_text(const std::shared_ptr<const SourceFile>& base,
                                        const std::vector<TextEdit>& edits,
                                        const std::shared_ptr<const SourceFile>& changed_by) {
  const std::uint32_t count = base->lines();
  const EditPlan plan(count, count > 0 && !base->line_end(count).empty(), edits);
  std::vector<ComposedPart> lines;
  lines.reserve(plan.lines().size());
  for (const PlannedLine& planned : plan.lines()) {
    if (planned.count > 1) {
      lines.emplace_back(LineRange{base.get(), planned.of_base, planned.count});
      continue;
    }
    const std::string_view end = planned.end_of == no_end        ? std::string_view{}
                                 : planned.end_of == default_end ? default_line_end
                                                                 : base->line_end(planned.end_of);
    if (planned.added != nullptr) {
      lines.emplace_back(ComposedLine{planned.added->text, end, planned.added->origin});
    } else {
      lines.emplace_back(ComposedLine{base->line(planned.of_base), end, base->origin(planned.of_base)});
    }
  }
  std::vector<std::shared_ptr<const SourceFile>> parts = base->parts();
  if (parts.empty()) parts.push_back(base);
  parts.insert(parts.begin(), changed_by);
  return std::make_unique<SourceFile>(changed_by->name(), lines, std::move(parts));
}

EditedBytes edited_bytes(std::string_view bytes, Encoding encoding, const std::vector<TextEdit>& edits,
                         bool allow_utf8) {
  EditedBytes edited;
  edited.bytes.reserve(bytes.size() + bytes.size() / 8);
  const std::string_view whole = bytes;
  for (const std::string_view mark : byte_order_marks) {
    if (edited.bytes.empty() && bytes.starts_with(mark) && (mark.size() == 2) == is_utf16(encoding)) {
      edited.bytes = mark;
      bytes.remove_prefix(mark.size());
    }
  }
  const std::vector<RawLine> base = raw_lines(bytes, encoding);
  const EditPlan plan(static_cast<std::uint32_t>(base.size()), !base.empty() && !base.back().end.empty(), edits);
  TextEncoder encoder(encoding, allow_utf8);
  ByteChanges changes(whole, edited.bytes);
  const auto keep = [&](std::string_view part) {
    if (!part.empty()) changes.keep(static_cast<std::size_t>(part.data() - whole.data()), part.size());
    edited.bytes += part;
  };
  for (const PlannedLine& planned : plan.lines()) {
    if (planned.count > 1) {  // all but the last line, with their line ends
      const char* const first = base[planned.of_base - 1].text.data();
      const std::string_view last = base[planned.of_base + planned.count - 3].end;
      keep({first, static_cast<std::size_t>(last.data() + last.size() - first)});
    }
    if (planned.added != nullptr) {
      encoder.append(edited.bytes, planned.added->text);
    } else {
      keep(base[planned.of_base + planned.count - 2].text);
    }
    if (planned.end_of == default_end) {
      encoder.append(edited.bytes, default_line_end);
    } else if (planned.end_of != no_end) {
      const bool is_own = planned.added == nullptr && planned.end_of == planned.of_base + planned.count - 1;
      if (is_own) {
        keep(base[planned.end_of - 1].end);
      } else {
        edited.bytes += base[planned.end_of - 1].end;
      }
    }
  }
  edited.changes = changes.finish();
  edited.error = encoder.error();
  return edited;
}

}  // namespace edsc
