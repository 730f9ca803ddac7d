#include "change/line_diff.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <unordered_map>
#include <utility>

namespace edsc {
namespace {

using Lines = std::vector<std::string_view>;

Lines lines_of(const SourceFile& file) {
  Lines lines;
  lines.reserve(file.lines());
  for (std::uint32_t line = 1; line <= file.lines(); ++line) lines.push_back(file.line(line));
  return lines;
}

/// Lines `first` to `last` - 1 of both texts, from 0.
struct DiffRange {
  std::size_t first_before = 0, last_before = 0;
  std::size_t first_after = 0, last_after = 0;

  [[nodiscard]] std::size_t before() const { return last_before - first_before; }
  [[nodiscard]] std::size_t after() const { return last_after - first_after; }
};

/// A line that both texts have.
struct CommonLine {
  std::size_t before = 0, after = 0;
};

/// Patience diff: lines that occur once in both texts, such as section headers, divide the texts into small parts.
/// Their differences have the longest common subsequence.
class LineDiff {
 public:
  LineDiff(const Lines& before, const Lines& after) : before_(before), after_(after) {}

  [[nodiscard]] std::vector<CommonLine> common_lines() {
    compare({0, before_.size(), 0, after_.size()});
    return std::move(common_);
  }

 private:
  /// Parts with more pairs of lines are different as a whole.
  static constexpr std::size_t max_pairs = std::size_t{1} << 20;

  void compare(DiffRange range) {
    while (range.before() > 0 && range.after() > 0 && before_[range.first_before] == after_[range.first_after]) {
      common_.push_back({range.first_before++, range.first_after++});
    }
    std::size_t same_end = 0;
    while (range.before() > 0 && range.after() > 0 && before_[range.last_before - 1] == after_[range.last_after - 1]) {
      --range.last_before;
      --range.last_after;
      ++same_end;
    }
    if (range.before() > 0 && range.after() > 0) divide(range);
    for (std::size_t i = 0; i < same_end; ++i) common_.push_back({range.last_before + i, range.last_after + i});
  }

  void divide(const DiffRange& range) {
    const std::vector<CommonLine> anchors = unique_lines(range);
    if (anchors.empty()) return compare_small(range);
    DiffRange part = range;
    for (const CommonLine& anchor : anchors) {
      compare({part.first_before, anchor.before, part.first_after, anchor.after});
      common_.push_back(anchor);
      part.first_before = anchor.before + 1;
      part.first_after = anchor.after + 1;
    }
    compare(part);
  }

  /// The longest ascending sequence of the lines that occur once in both parts.
  [[nodiscard]] std::vector<CommonLine> unique_lines(const DiffRange& range) const {
    struct Place {
      std::size_t before = 0, after = 0;
      unsigned count_before = 0, count_after = 0;
    };
    std::unordered_map<std::string_view, Place> places;
    for (std::size_t i = range.first_before; i < range.last_before; ++i) {
      Place& place = places[before_[i]];
      place.before = i;
      ++place.count_before;
    }
    for (std::size_t i = range.first_after; i < range.last_after; ++i) {
      const auto found = places.find(after_[i]);
      if (found == places.end()) continue;
      found->second.after = i;
      ++found->second.count_after;
    }
    std::vector<CommonLine> unique;
    for (std::size_t i = range.first_before; i < range.last_before; ++i) {
      const Place& place = places[before_[i]];
      if (place.count_before == 1 && place.count_after == 1) unique.push_back({i, place.after});
    }
    return longest_ascending(unique);
  }

  [[nodiscard]] static std::vector<CommonLine> longest_ascending(const std::vector<CommonLine>& lines) {
    std::vector<std::size_t> ends;  // of the sequences of each length: the one with the lowest end
    std::vector<std::size_t> previous(lines.size(), lines.size());
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const auto at =
          std::ranges::lower_bound(ends, lines[i].after, {}, [&](std::size_t end) { return lines[end].after; });
      if (at != ends.begin()) previous[i] = *std::prev(at);
      if (at == ends.end()) {
        ends.push_back(i);
      } else {
        *at = i;
      }
    }
    std::vector<CommonLine> sequence;
    for (std::size_t i = ends.empty() ? lines.size() : ends.back(); i < lines.size(); i = previous[i]) {
      sequence.push_back(lines[i]);
    }
    std::ranges::reverse(sequence);
    return sequence;
  }

  void compare_small(const DiffRange& range) {
    const std::size_t rows = range.before();
    const std::size_t columns = range.after();
    if (rows > max_pairs / columns) return;
    std::vector<std::uint32_t> lengths((rows + 1) * (columns + 1), 0);
    const auto at = [&](std::size_t row, std::size_t column) -> std::uint32_t& {
      return lengths[row * (columns + 1) + column];
    };
    const auto is_same = [&](std::size_t row, std::size_t column) {
      return before_[range.first_before + row] == after_[range.first_after + column];
    };
    for (std::size_t row = rows; row-- > 0;) {
      for (std::size_t column = columns; column-- > 0;) {
        at(row, column) =
            is_same(row, column) ? at(row + 1, column + 1) + 1 : std::max(at(row + 1, column), at(row, column + 1));
      }
    }
    for (std::size_t row = 0, column = 0; row < rows && column < columns;) {
      if (is_same(row, column)) {
        common_.push_back({range.first_before + row++, range.first_after + column++});
      } else if (at(row + 1, column) >= at(row, column + 1)) {
        ++row;
      } else {
        ++column;
      }
    }
  }

  const Lines& before_;
  const Lines& after_;
  std::vector<CommonLine> common_;
};

constexpr std::uint32_t context_lines = 3;

/// One part of a unified diff: its lines, and their numbers.
class DiffHunk {
 public:
  DiffHunk(std::uint32_t line_before, std::uint32_t line_after) : line_before_(line_before), line_after_(line_after) {}

  void add(char mark, std::string_view line) {
    text_ += fmt::format("{}{}\n", mark, line);
    if (mark != '+') ++before_;
    if (mark != '-') ++after_;
  }

  [[nodiscard]] std::uint32_t end_before() const { return line_before_ + before_; }
  [[nodiscard]] std::uint32_t end_after() const { return line_after_ + after_; }
  [[nodiscard]] std::string text() const {
    return fmt::format("@@ -{},{} +{},{} @@\n{}", before_ == 0 ? line_before_ - 1 : line_before_, before_,
                       after_ == 0 ? line_after_ - 1 : line_after_, after_, text_);
  }

 private:
  std::uint32_t line_before_, line_after_;
  std::uint32_t before_ = 0, after_ = 0;
  std::string text_;
};

}  // namespace

std::vector<TextEdit> line_edits(const SourceFile& before, const SourceFile& after) {
  const Lines old_lines = lines_of(before);
  const Lines new_lines = lines_of(after);
  std::vector<CommonLine> common = LineDiff(old_lines, new_lines).common_lines();
  common.push_back({old_lines.size(), new_lines.size()});
  std::vector<TextEdit> edits;
  CommonLine next;
  for (const CommonLine& line : common) {
    if (line.before != next.before || line.after != next.after) {
      TextEdit edit{
          static_cast<std::uint32_t>(next.before + 1), static_cast<std::uint32_t>(line.before - next.before), {}};
      for (std::size_t i = next.after; i < line.after; ++i) edit.lines.push_back({std::string{new_lines[i]}, {}});
      edits.push_back(std::move(edit));
    }
    next = {line.before + 1, line.after + 1};
  }
  return edits;
}

std::string unified_diff(const SourceFile& before, const std::vector<TextEdit>& edits, std::string_view name) {
  if (edits.empty()) return {};
  std::string text = fmt::format("--- {}\n+++ {}\n", name, name);
  const auto start_of = [](std::uint32_t line) { return line > context_lines ? line - context_lines : 1; };
  std::int64_t shift = 0;
  for (std::size_t i = 0; i < edits.size();) {
    const std::uint32_t start = start_of(edits[i].line);
    DiffHunk hunk(start, static_cast<std::uint32_t>(start + shift));
    const auto keep_until = [&](std::uint32_t end) {
      while (hunk.end_before() < end) hunk.add(' ', before.line(hunk.end_before()));
    };
    do {
      const TextEdit& edit = edits[i];
      keep_until(edit.line);
      for (std::uint32_t line = 0; line < edit.removed; ++line) hunk.add('-', before.line(edit.line + line));
      for (const NewLine& line : edit.lines) hunk.add('+', line.text);
      shift += static_cast<std::int64_t>(edit.lines.size()) - edit.removed;
      ++i;
    } while (i < edits.size() && start_of(edits[i].line) <= hunk.end_before() + context_lines);
    keep_until(std::min(hunk.end_before() + context_lines, before.lines() + 1));
    text += hunk.text();
  }
  return text;
}

}  // namespace edsc
