/// Comments of an EDS that allow findings: `; edsc: allow RULE - reason`.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "diagnostics/diagnostics.hpp"

namespace edsc {

/// A comment that begins with `; edsc:`.
struct AllowComment {
  Position position;        ///< of the rule, else of the comment
  std::string_view rule;    ///< empty if the comment is malformed
  std::string_view reason;  ///< empty if missing
  AllowanceScope scope;     ///< the next line or section; before the first section the file
  bool has_target = false;  ///< false if only comments and blank lines follow
};

struct AllowComments {
  SheetOutline outline;  ///< sections, and list lines that refer to another object or entry
  std::vector<AllowComment> comments;
};

/// Finds the comments and their targets in the lines of an EDS or DCF. A comment applies to the next line that is
/// neither a comment nor empty: a key, or a whole section. A comment before the first section applies to the file,
/// those after a section header on the same line to that section.
[[nodiscard]] AllowComments find_allow_comments(const SourceFile& source);

/// Whether a comment, with its `;` or `#`, begins with `; edsc:`.
[[nodiscard]] bool is_for_edsc(std::string_view comment);

/// Splits the comment after a section header before each further `; edsc:`.
[[nodiscard]] std::vector<std::string_view> split_header_comment(std::string_view comment);

}  // namespace edsc
