/// The merge of two versions of an EDS or DCF by section and key, for `git merge`.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "text/source_file.hpp"

namespace edsc {

struct MergedSheet {
  std::string text;                    ///< UTF-8, with the line ends of our version
  std::vector<std::string> conflicts;  ///< titles of the sections with conflict markers
};

/// Applies what `theirs` changes in `base` to `ours`. Object lists, SubNumber, sub-index 0 and the numbers of PDOs
/// follow from the objects. A key or section that both change differently is a conflict, with both versions between
/// markers.
[[nodiscard]] MergedSheet merge_sheets(const SourceFile& base, const SourceFile& ours, const SourceFile& theirs);

}  // namespace edsc
