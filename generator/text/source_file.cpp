#include "text/source_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "system/gzip.hpp"
#include "system/path.hpp"
#include "system/read_file.hpp"
#include "text/code_page.hpp"
#include "text/utf8.hpp"

namespace edsc {
namespace {

constexpr std::string_view utf8_mark = "\xEF\xBB\xBF";
constexpr std::string_view utf16_le_mark = "\xFF\xFE";
constexpr std::string_view utf16_be_mark = "\xFE\xFF";

static_assert(SourceFile::max_bytes == max_file_bytes);
constexpr std::string_view too_large = "larger than 1 GiB";

/// Detects UTF-16 without a byte order mark: at the start of the text, exactly every second byte is NUL.
bool has_nul_as_every_second_byte(std::string_view bytes, std::size_t first_nul) {
  const std::string_view start = bytes.substr(0, 512);
  if (start.size() < 4) {
    return false;
  }
  for (std::size_t at = 0; at < start.size(); ++at) {
    if ((start[at] == '\0') != (at % 2 == first_nul)) {
      return false;
    }
  }
  return true;
}

/// The name of a file in diagnostics.
std::string name_of(const std::string& path) { return path == "-" ? "<stdin>" : from_native(to_native(path)); }

}  // namespace

SourceFile::SourceFile(std::string name, std::string bytes, Packing packing, const ReadingChoices& choices)
    : name_(std::move(name)), packing_(packing), choices_(choices) {
  if (bytes.size() > max_bytes) {
    throw std::length_error(name_ + ": " + std::string(too_large));
  }
  decode(std::move(bytes));
  find_lines();
}

SourceFile::SourceFile(std::string name, const std::vector<ComposedPart>& lines,
                       std::vector<std::shared_ptr<const SourceFile>> parts)
    : name_(std::move(name)),
      encoding_(parts.back()->encoding_),
      choices_(parts.back()->choices_),
      parts_(std::move(parts)) {
  std::size_t size = 0;
  std::size_t count = 0;
  for (const ComposedPart& part : lines) {
    const auto* const range = std::get_if<LineRange>(&part);
    const auto* const line = std::get_if<ComposedLine>(&part);
    size += range != nullptr ? text_of(*range).size() : line->text.size() + line->end.size();
    count += range != nullptr ? range->count : 1;
  }
  if (size > max_bytes) {
    throw std::length_error(name_ + ": " + std::string(too_large));
  }
  text_.reserve(size);
  starts_.reserve(count + 1);
  origins_.reserve(count);
  for (const ComposedPart& part : lines) {
    const auto start = static_cast<std::uint32_t>(text_.size());
    if (const auto* const line = std::get_if<ComposedLine>(&part)) {
      starts_.push_back(start);
      origins_.push_back(line->origin);
      text_.append(line->text).append(line->end);
      continue;
    }
    const LineRange& range = std::get<LineRange>(part);
    const std::uint32_t start_there = range.file->starts_[range.first - 1];
    for (std::uint32_t line = range.first; line < range.first + range.count; ++line) {
      starts_.push_back(start + range.file->starts_[line - 1] - start_there);
    }
    if (const std::vector<LineOrigin>& origins = range.file->origins_; !origins.empty()) {
      origins_.insert(origins_.end(), origins.begin() + (range.first - 1),
                      origins.begin() + (range.first - 1 + range.count));
    } else {
      for (std::uint32_t i = 0; i < range.count; ++i) origins_.push_back({.file = range.file, .line = range.first + i});
    }
    text_ += text_of(range);
  }
  starts_.push_back(static_cast<std::uint32_t>(text_.size()));
}

std::string_view SourceFile::text_of(const LineRange& range) {
  const std::vector<std::uint32_t>& starts = range.file->starts_;
  const std::uint32_t start = starts[range.first - 1];
  return range.file->text().substr(start, starts[range.first + range.count - 1] - start);
}

void SourceFile::decode(std::string bytes) {
  const std::string_view view = bytes;
  if (view.starts_with(utf16_le_mark) || view.starts_with(utf16_be_mark)) {
    convert(view.substr(2), view.starts_with(utf16_le_mark) ? Encoding::utf16_le : Encoding::utf16_be);
  } else if (has_nul_as_every_second_byte(view, 1) || has_nul_as_every_second_byte(view, 0)) {
    convert(view, view[1] == '\0' ? Encoding::utf16_le : Encoding::utf16_be);
  } else if (view.starts_with(utf8_mark) && is_utf8(view)) {
    encoding_ = Encoding::utf8;
    text_ = bytes.substr(utf8_mark.size());
  } else if (choices_.encoding.value_or(Encoding::utf8) == Encoding::utf8 ? is_utf8(view) : is_ascii(view)) {
    encoding_ = is_ascii(view) ? Encoding::ascii : Encoding::utf8;
    text_ = std::move(bytes);
    is_verbatim_ = packing_ == Packing::none;
  } else {
    convert(view, choices_.encoding ? *choices_.encoding : detect_code_page(view));
  }
}

void SourceFile::convert(std::string_view bytes, Encoding encoding) {
  encoding_ = encoding;
  DecodedText decoded = decode_text(bytes, encoding);
  text_ = std::move(decoded.text);
  if (decoded.is_valid()) return;
  undefined_place_ = decoded.undefined_text;
  const auto is_ascii_byte = [](char c) { return static_cast<unsigned char>(c) < 0x80; };
  const std::string_view from_there = bytes.substr(decoded.undefined, byte_count);
  const auto end =
      encoding == Encoding::unknown ? std::ranges::find_if(from_there, is_ascii_byte) : from_there.begin() + 1;
  undefined_bytes_.assign(from_there.begin(), end);
  possible_ = possible_encodings(bytes);
}

bool SourceFile::is_encoding_guessed() const {
  return !choices_.encoding && (encoding_ == Encoding::cp437 || encoding_ == Encoding::unknown);
}

void SourceFile::find_lines() {
  starts_.reserve(text_.size() / 16 + 2);
  starts_.push_back(0);
  for (std::size_t at = 0; at < text_.size(); ++at) {
    const char c = text_[at];
    if (c > '\r') {
      continue;
    }
    const bool is_cr_of_cr_lf = c == '\r' && at + 1 < text_.size() && text_[at + 1] == '\n';
    if (c == '\n' || (c == '\r' && !is_cr_of_cr_lf)) {
      starts_.push_back(static_cast<std::uint32_t>(at + 1));
    }
  }
  if (starts_.back() != text_.size()) {
    starts_.push_back(static_cast<std::uint32_t>(text_.size()));
  }
}

std::string_view SourceFile::line(std::uint32_t number) const {
  if (number == 0 || number > lines()) {
    return {};
  }
  const std::uint32_t start = starts_[number - 1];
  std::string_view line = text().substr(start, starts_[number] - start);
  if (line.ends_with('\n')) {
    line.remove_suffix(1);
  }
  if (line.ends_with('\r')) {
    line.remove_suffix(1);
  }
  return line;
}

std::string undefined_bytes_text(const SourceFile& source) {
  std::string text = "bytes";
  for (const char c : source.undefined_bytes()) {
    fmt::format_to(std::back_inserter(text), " {:02X}h", static_cast<unsigned char>(c));
  }
  text += source.encoding() == Encoding::unknown ? " are not ASCII, and the encoding is not known"
                                                 : fmt::format(" are not defined in {}", to_string(source.encoding()));
  const std::vector<Encoding>& possible = source.possible();
  for (std::size_t i = 0; i < possible.size(); ++i) {
    const bool is_last = i + 1 == possible.size();
    text.append(i == 0 ? "; the text is valid " : is_last ? " and " : ", ").append(to_string(possible[i]));
  }
  return text;
}

std::string_view SourceFile::line_end(std::uint32_t number) const {
  if (number == 0 || number > lines()) return {};
  const std::uint32_t start = starts_[number - 1];
  return text().substr(start, starts_[number] - start).substr(line(number).size());
}

LineOrigin SourceFile::origin(std::uint32_t line) const {
  if (line == 0 || line > origins_.size()) return {.file = this, .line = line};
  return origins_[line - 1];
}

FileBytes read_bytes(const std::string& path) {
  FileBytes file;
  std::string why = read_file(path, file.bytes);
  file.packing = is_gzip(file.bytes) ? Packing::gzip : Packing::none;
  if (why.empty() && file.packing == Packing::gzip) {
    const std::string packed = std::move(file.bytes);
    why = gunzip(packed, SourceFile::max_unpacked_bytes, file.bytes);
  }
  if (!why.empty()) file.error = "cannot read " + name_of(path) + ": " + why;
  return file;
}

std::unique_ptr<SourceFile> read_source_file(const std::string& path, std::string& error,
                                             const ReadingChoices& choices) {
  FileBytes file = read_bytes(path);
  if (!file.error.empty()) {
    error = std::move(file.error);
    return nullptr;
  }
  return std::make_unique<SourceFile>(name_of(path), std::move(file.bytes), file.packing, choices);
}

}  // namespace edsc
