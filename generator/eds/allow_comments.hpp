/// Comments of a data sheet that allow findings: `; edsc: allow RULE - reason`.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "diagnostics/diagnostics.hpp"

namespace edsc {

/// A comment that begins with `; edsc:`.
struct AllowComment {
  Position position;         ///< of the rule, else of the comment
  std::string_view rule;     ///< empty when the comment is not of this form
  std::string_view reason;   ///< empty where it is missing
  AllowanceScope scope;      ///< the next line or section; before the first section the file
  bool has_target = false;   ///< false where only comments and blank lines follow
};

struct AllowComments {
  SheetOutline outline;  ///< sections, and lines of lists that name another object or entry
  std::vector<AllowComment> comments;
};

/// Finds the comments, and what they apply to, in the lines of an EDS or DCF. A comment applies to the next line that is
/// neither a comment nor empty: a key, or a section as a whole. One before the first section applies to the file, one
/// after a section's header in the same line to that section.
[[nodiscard]] AllowComments find_allow_comments(const SourceFile& source);

}  // namespace edsc
