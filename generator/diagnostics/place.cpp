#include "diagnostics/place.hpp"

#include <algorithm>
#include <string_view>

#include "text/source_file.hpp"
#include "text/utf8.hpp"

namespace edsc {

Position origin_of(const Position& position) {
  if (position.file == nullptr || position.line == 0 || position.file->parts().empty()) return position;
  const LineOrigin origin = position.file->origin(position.line);
  std::uint32_t column = position.column;
  if (origin.value_column != 0) {
    column = column < origin.value_column ? origin.origin_key_column
                                          : origin.origin_value_column + (column - origin.value_column);
  }
  return {origin.file, origin.line, column, position.length};
}

Place place_of(const Position& composed) {
  const Position position = origin_of(composed);
  if (position.file == nullptr) {
    return {};
  }
  if (position.line == 0) {
    return {position.file->name(), 1, 1, 1};
  }
  const std::string_view line = position.file->line(position.line);
  const std::size_t start = std::min<std::size_t>(position.column == 0 ? 0 : position.column - 1, line.size());
  return {position.file->name(), position.line, count_code_points(line.substr(0, start)) + 1,
          std::max<std::size_t>(count_code_points(line.substr(start, position.length)), 1)};
}

Position position_at(const SourceFile& source, std::size_t offset, std::size_t length) {
  const auto start_of = [&](std::uint32_t line) {
    return static_cast<std::size_t>(source.line(line).data() - source.text().data());
  };
  std::uint32_t line = 1;
  for (std::uint32_t count = source.lines(); count > 1;) {  // it is among the `count` lines from `line` on
    const std::uint32_t half = count / 2;
    const bool is_after = start_of(line + half) <= offset;
    line += is_after ? half : 0;
    count = is_after ? count - half : half;
  }
  const std::size_t column = line == 1 ? offset : offset - start_of(line);
  return {&source, line, static_cast<std::uint32_t>(column) + 1,
          static_cast<std::uint32_t>(std::max<std::size_t>(length, 1))};
}

}  // namespace edsc
