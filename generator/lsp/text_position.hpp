/// Positions as the Language Server Protocol has them: lines and columns from 0, columns in bytes or in UTF-16 units.
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "diagnostics/position.hpp"

namespace edsc::lsp {

using Json = nlohmann::json;

enum class PositionEncoding : std::uint8_t { utf8, utf16 };

struct TextPosition {
  std::uint32_t line = 0;
  std::uint32_t character = 0;
};

struct TextRange {
  TextPosition start;
  TextPosition end;
};

/// Columns before `bytes` bytes of a line.
[[nodiscard]] std::uint32_t units_before(std::string_view line, std::size_t bytes, PositionEncoding encoding);
/// Bytes before a column of a line; its length for a column after its end.
[[nodiscard]] std::size_t bytes_before(std::string_view line, std::size_t units, PositionEncoding encoding);

/// The range of a position in its file. A whole file is its first line.
[[nodiscard]] TextRange range_of(const Position& position, PositionEncoding encoding);

/// `bytes` of a line, which counts from 1, as a range; `column` counts from 1.
[[nodiscard]] TextRange range_in(const SourceFile& source, std::uint32_t line, std::uint32_t column, std::size_t bytes,
                                 PositionEncoding encoding);

[[nodiscard]] bool overlap(const TextRange& a, const TextRange& b);

[[nodiscard]] Json to_json(const TextPosition& position);
[[nodiscard]] Json to_json(const TextRange& range);
/// Throw nlohmann's exceptions for another form.
[[nodiscard]] TextPosition position_from(const Json& json);
[[nodiscard]] TextRange range_from(const Json& json);

/// Replaces a range of a text; a position after the end of a line, or of the text, is the end.
void replace_range(std::string& text, const TextRange& range, std::string_view by, PositionEncoding encoding);

/// A `file:` URI as a path; another URI remains as it is.
[[nodiscard]] std::string path_of_uri(std::string_view uri);
[[nodiscard]] std::string uri_of_file(const std::string& path);

}  // namespace edsc::lsp
