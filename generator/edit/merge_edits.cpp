#include "edit/merge_edits.hpp"

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>

#include "change/line_diff.hpp"
#include "change/text_edit.hpp"

namespace edsc::edit {
namespace {

std::uint32_t end_of(const TextEdit& edit) { return edit.line + edit.removed; }

/// Whether two edits change a line, or insert at a place, that the other one changes.
bool overlap(std::uint32_t line, std::uint32_t end, const TextEdit& edit) {
  if (line == end || edit.removed == 0) return edit.line <= end && line <= end_of(edit);
  return edit.line < end && line < end_of(edit);
}

/// Lines `line` to before `end` of a text, after the edits among them.
std::vector<std::string> lines_after(const SourceFile& text, std::uint32_t line, std::uint32_t end,
                                     std::span<const TextEdit> edits) {
  std::vector<std::string> lines;
  const auto copy_to = [&](std::uint32_t to) {
    for (; line < to; ++line) lines.emplace_back(text.line(line));
  };
  for (const TextEdit& edit : edits) {
    copy_to(edit.line);
    for (const NewLine& one : edit.lines) lines.push_back(one.text);
    line = end_of(edit);
  }
  copy_to(end);
  return lines;
}

std::int64_t growth(const TextEdit& edit) {
  return static_cast<std::int64_t>(edit.lines.size()) - static_cast<std::int64_t>(edit.removed);
}

std::uint32_t moved(std::uint32_t line, std::int64_t distance) {
  return static_cast<std::uint32_t>(std::int64_t{line} + distance);
}

/// Walks through the edits of both sides in the order of the lines of their base.
class Merge {
 public:
  Merge(const SourceFile& base, const SourceFile& mine, const SourceFile& theirs)
      : base_{base}, mine_{line_edits(base, mine)}, theirs_{line_edits(base, theirs)} {}

  /// The edits of mine that remain, of the lines of theirs.
  std::vector<TextEdit> run() {
    while (my_next_ < mine_.size()) {
      const TextEdit& mine = mine_[my_next_];
      skip_theirs_before(mine);
      if (their_next_ == theirs_.size() || !overlap(mine.line, end_of(mine), theirs_[their_next_])) {
        edits_.push_back(mine);
        edits_.back().line = moved(mine.line, shift_);
        my_growth_ += growth(mine);
        ++my_next_;
      } else {
        take_theirs();
      }
    }
    return std::move(edits_);
  }

  [[nodiscard]] std::vector<EditConflict> conflicts() { return std::move(conflicts_); }

 private:
  void skip_theirs_before(const TextEdit& mine) {
    while (their_next_ < theirs_.size() && !overlap(mine.line, end_of(mine), theirs_[their_next_]) &&
           theirs_[their_next_].line <= mine.line) {
      shift_ += growth(theirs_[their_next_++]);
    }
  }

  /// The edits of both sides that overlap, directly or by others.
  void take_theirs() {
    const std::size_t my_first = my_next_;
    const std::size_t their_first = their_next_;
    std::uint32_t line = std::min(mine_[my_next_].line, theirs_[their_next_].line);
    std::uint32_t end = std::max(end_of(mine_[my_next_]), end_of(theirs_[their_next_]));
    ++my_next_;
    ++their_next_;
    for (bool grows = true; grows;) {
      grows = false;
      const auto take = [&](const std::vector<TextEdit>& edits, std::size_t& next) {
        if (next == edits.size() || !overlap(line, end, edits[next])) return;
        end = std::max(end, end_of(edits[next++]));
        grows = true;
      };
      take(mine_, my_next_);
      take(theirs_, their_next_);
    }
    const std::span my_edits{mine_.begin() + static_cast<std::ptrdiff_t>(my_first), my_next_ - my_first};
    const std::span their_edits{theirs_.begin() + static_cast<std::ptrdiff_t>(their_first), their_next_ - their_first};
    EditConflict conflict{static_cast<std::uint32_t>(conflicts_.size() + 1), moved(line, shift_ + my_growth_),
                          lines_after(base_, line, end, {}), lines_after(base_, line, end, my_edits),
                          lines_after(base_, line, end, their_edits)};
    for (const TextEdit& edit : their_edits) shift_ += growth(edit);
    if (conflict.mine != conflict.theirs) conflicts_.push_back(std::move(conflict));
  }

  const SourceFile& base_;
  std::vector<TextEdit> mine_, theirs_;
  std::size_t my_next_ = 0, their_next_ = 0;
  std::int64_t shift_ = 0;      ///< from a line of the base to one of theirs
  std::int64_t my_growth_ = 0;  ///< of the edits of mine so far
  std::vector<TextEdit> edits_;
  std::vector<EditConflict> conflicts_;
};

}  // namespace

MergedEdits merge_edits(const SourceFile& base, const SourceFile& mine, const SourceFile& theirs,
                        const std::string& their_bytes) {
  Merge merge{base, mine, theirs};
  const std::vector<TextEdit> edits = merge.run();
  EditedBytes edited = edited_bytes(their_bytes, theirs.encoding(), edits, true);
  MergedEdits merged{std::move(edited.bytes), merge.conflicts(), std::move(edited.error)};
  if (edits.empty()) merged.bytes = their_bytes;
  return merged;
}

MergedEdits resolve_conflict(const SourceFile& text, const std::string& bytes, std::vector<EditConflict> conflicts,
                             std::uint32_t id, bool keeps_mine) {
  MergedEdits result{bytes, std::move(conflicts), {}};
  const auto chosen = std::ranges::find(result.conflicts, id, &EditConflict::id);
  if (chosen == result.conflicts.end()) {
    result.problem = "this conflict is resolved already";
    return result;
  }
  if (keeps_mine) {
    TextEdit edit{chosen->line, static_cast<std::uint32_t>(chosen->theirs.size()), {}};
    for (const std::string& line : chosen->mine) edit.lines.push_back({line, {}});
    EditedBytes edited = edited_bytes(bytes, text.encoding(), {edit}, true);
    if (!edited.error.empty()) {
      result.problem = std::move(edited.error);
      return result;
    }
    result.bytes = std::move(edited.bytes);
    for (auto later = std::next(chosen); later != result.conflicts.end(); ++later) {
      later->line = moved(later->line, growth(edit));
    }
  }
  result.conflicts.erase(chosen);
  return result;
}

}  // namespace edsc::edit
