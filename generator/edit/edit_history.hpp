/// The steps that changed the bytes of a file, to undo and to redo.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "change/text_edit.hpp"

namespace edsc::edit {

/// What one request changed.
struct EditStep {
  std::string name;             ///< `map 6041h:00 to TPDO 1`
  std::vector<ByteEdit> edits;  ///< of the bytes before
};

/// The edits that take these back.
[[nodiscard]] std::vector<ByteEdit> inverse(std::span<const ByteEdit> edits);

/// The smallest edit that makes one text of another; no edit if they are equal.
[[nodiscard]] std::vector<ByteEdit> bytes_between(std::string_view before, std::string_view after);

/// Without a limit of their number. It does not have the bytes of the file.
class EditHistory {
 public:
  /// Adds a step, after which no other one can be redone.
  void add(EditStep step);
  /// One step replaces all; none if it does not have edits.
  void restart(EditStep step);

  /// The step that is undone next; null if there is none. The same for redo.
  [[nodiscard]] const EditStep* to_undo() const { return done_ == 0 ? nullptr : &steps_[done_ - 1]; }
  [[nodiscard]] const EditStep* to_redo() const { return done_ == steps_.size() ? nullptr : &steps_[done_]; }
  /// The caller has undone, or redone, the step.
  void undone() { --done_; }
  void redone() { ++done_; }

  [[nodiscard]] std::size_t done() const { return done_; }

 private:
  std::vector<EditStep> steps_;
  std::size_t done_ = 0;
};

}  // namespace edsc::edit
