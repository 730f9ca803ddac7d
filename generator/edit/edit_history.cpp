#include "edit/edit_history.hpp"

#include <algorithm>
#include <utility>

namespace edsc::edit {

std::vector<ByteEdit> inverse(std::span<const ByteEdit> edits) {
  std::vector<ByteEdit> result;
  std::size_t grown = 0;  // modulo 2^64: edits may also shorten the text
  for (const ByteEdit& edit : edits) {
    result.push_back({edit.offset + grown, edit.after, edit.before});
    grown += edit.after.size() - edit.before.size();
  }
  return result;
}

std::vector<ByteEdit> bytes_between(std::string_view before, std::string_view after) {
  if (before == after) return {};
  const auto [left, right] = std::ranges::mismatch(before, after);
  const auto start = static_cast<std::size_t>(left - before.begin());
  std::size_t same = 0;
  const std::size_t most = std::min(before.size(), after.size()) - start;
  while (same < most && before[before.size() - 1 - same] == after[after.size() - 1 - same]) ++same;
  return {{start, std::string{before.substr(start, before.size() - start - same)},
           std::string{after.substr(start, after.size() - start - same)}}};
}

void EditHistory::add(EditStep step) {
  steps_.resize(done_);
  steps_.push_back(std::move(step));
  ++done_;
}

void EditHistory::restart(EditStep step) {
  steps_.clear();
  done_ = 0;
  if (!step.edits.empty()) add(std::move(step));
}

}  // namespace edsc::edit
