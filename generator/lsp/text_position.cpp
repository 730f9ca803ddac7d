#include "lsp/text_position.hpp"

#include <algorithm>
#include <tuple>

#include "system/path.hpp"
#include "text/number_text.hpp"
#include "text/source_file.hpp"
#include "text/utf8.hpp"

namespace edsc::lsp {
namespace {

/// The start of a line that counts from 0; the end of the text if it has fewer lines. As in a SourceFile, LF, CR LF and
/// CR end a line.
std::size_t start_of_line(std::string_view text, std::uint32_t line) {
  std::size_t at = 0;
  for (; line > 0 && at < text.size(); --line) {
    at = text.find_first_of("\r\n", at);
    if (at == std::string_view::npos) return text.size();
    at += text.substr(at).starts_with("\r\n") ? 2 : 1;
  }
  return at;
}

std::size_t offset_of(std::string_view text, const TextPosition& position, PositionEncoding encoding) {
  const std::size_t start = start_of_line(text, position.line);
  const std::size_t end = std::min(text.find_first_of("\r\n", start), text.size());
  return start + bytes_before(text.substr(start, end - start), position.character, encoding);
}

std::string percent_decoded(std::string_view text) {
  std::string decoded;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const auto byte =
        text[at] == '%' && text.size() - at > 2 ? parse_whole<std::uint8_t>(text.substr(at + 1, 2), 16) : std::nullopt;
    decoded += byte ? static_cast<char>(*byte) : text[at];
    if (byte) at += 2;
  }
  return decoded;
}

bool has_drive(std::string_view path) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  return path.size() > 2 && path[0] == '/' && is_letter(path[1]) && path[2] == ':';
}

}  // namespace

std::uint32_t units_before(std::string_view line, std::size_t bytes, PositionEncoding encoding) {
  const std::string_view before = line.substr(0, std::min(bytes, line.size()));
  if (encoding == PositionEncoding::utf8) return static_cast<std::uint32_t>(before.size());
  std::uint32_t units = 0;
  for_each_code_point(before, [&](char32_t code_point) { units += code_point > 0xFFFF ? 2 : 1; });
  return units;
}

std::size_t bytes_before(std::string_view line, std::size_t units, PositionEncoding encoding) {
  if (encoding == PositionEncoding::utf8) return std::min(units, line.size());
  std::size_t at = 0;
  for (std::size_t count = 0; at < line.size();) {
    const std::size_t length = std::max<std::size_t>(utf8_sequence_length(line.substr(at)), 1);
    count += length == 4 ? 2 : 1;
    if (count > units) break;
    at += length;
  }
  return at;
}

TextRange range_in(const SourceFile& source, std::uint32_t line, std::uint32_t column, std::size_t bytes,
                   PositionEncoding encoding) {
  const std::string_view text = source.line(line);
  const std::size_t start = std::min<std::size_t>(column == 0 ? 0 : column - 1, text.size());
  const std::uint32_t number = line == 0 ? 0 : line - 1;
  return {{number, units_before(text, start, encoding)}, {number, units_before(text, start + bytes, encoding)}};
}

TextRange range_of(const Position& position, PositionEncoding encoding) {
  if (position.file == nullptr) return {};
  if (position.line == 0) return range_in(*position.file, 1, 1, position.file->line(1).size(), encoding);
  return range_in(*position.file, position.line, position.column, position.length, encoding);
}

bool overlap(const TextRange& a, const TextRange& b) {
  const auto order = [](const TextPosition& position) { return std::tuple{position.line, position.character}; };
  return order(a.start) <= order(b.end) && order(b.start) <= order(a.end);
}

Json to_json(const TextPosition& position) { return {{"line", position.line}, {"character", position.character}}; }

Json to_json(const TextRange& range) { return {{"start", to_json(range.start)}, {"end", to_json(range.end)}}; }

TextPosition position_from(const Json& json) {
  return {json.at("line").get<std::uint32_t>(), json.at("character").get<std::uint32_t>()};
}

TextRange range_from(const Json& json) { return {position_from(json.at("start")), position_from(json.at("end"))}; }

void replace_range(std::string& text, const TextRange& range, std::string_view by, PositionEncoding encoding) {
  const std::size_t start = offset_of(text, range.start, encoding);
  const std::size_t end = std::max(start, offset_of(text, range.end, encoding));
  text.replace(start, end - start, by);
}

std::string path_of_uri(std::string_view uri) {
  constexpr std::string_view scheme = "file://";
  if (!uri.starts_with(scheme)) return std::string{uri};
  std::string path = percent_decoded(uri.substr(scheme.size()));
  if (path.starts_with("localhost/")) path.erase(0, std::string_view{"localhost"}.size());
  if (!path.starts_with('/')) path.insert(0, "//");
  if (has_drive(path)) path.erase(0, 1);
  return from_native(to_native(path));
}

std::string uri_of_file(const std::string& path) {
  return path.find("://") == std::string::npos && !path.starts_with("untitled:") ? uri_of_path(absolute_path(path))
                                                                                 : path;
}

}  // namespace edsc::lsp
