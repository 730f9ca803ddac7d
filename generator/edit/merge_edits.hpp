/// Unsaved edits of a file that another program has changed.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "text/source_file.hpp"

namespace edsc::edit {

/// Lines that both changed. The merged text has those of the other program.
struct EditConflict {
  std::uint32_t id = 0;
  std::uint32_t line = 0;  ///< the first one, in the merged text
  std::vector<std::string> base, mine, theirs;
};

struct MergedEdits {
  std::string bytes;
  std::vector<EditConflict> conflicts;  ///< ascending by line, with ids from 1
  std::string problem;                  ///< names a character that the encoding of the changed file cannot express
};

/// Makes the edits from `base` to `mine` in `theirs`, the changed file with these bytes.
[[nodiscard]] MergedEdits merge_edits(const SourceFile& base, const SourceFile& mine, const SourceFile& theirs,
                                      const std::string& their_bytes);

/// The bytes of a text, with `mine` in place of the lines of the other program. The lines of later conflicts move.
[[nodiscard]] MergedEdits resolve_conflict(const SourceFile& text, const std::string& bytes,
                                           std::vector<EditConflict> conflicts, std::uint32_t id, bool keeps_mine);

}  // namespace edsc::edit
