#include "diagnostics/place.hpp"

#include <algorithm>
#include <string_view>

#include "text/source_file.hpp"
#include "text/utf8.hpp"

namespace edsc {

Place place_of(const Position& position) {
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

}  // namespace edsc
