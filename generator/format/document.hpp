/// An INI text on its way out: sections and entries with the comments that stand before them.
#pragma once

#include <string>
#include <vector>

#include "eds/ini.hpp"
#include "eds/section_name.hpp"

namespace edsc {

/// Each line of a comment, with its `;`.
using Remarks = std::vector<std::string>;

struct DocumentEntry {
  Remarks remarks;  ///< before it
  std::string key;
  std::string value;
};

struct DocumentSection {
  Remarks remarks;   ///< before it
  SectionName kind;  ///< what its title says
  std::string title;
  std::vector<DocumentEntry> entries;
};

struct Document {
  Remarks head;  ///< what stands at the top, a blank line before the first section
  std::vector<DocumentSection> sections;
  Remarks tail;  ///< behind the last entry
};

/// All that the file holds, in its order. Comments that begin with `#`, and lines that are neither section nor entry,
/// become
/// `;` comments.
[[nodiscard]] Document document_of(const IniFile& ini);

/// LF, one blank line between sections, no blanks around `=`.
[[nodiscard]] std::string to_text(const Document& document);

/// `text` as a line of a comment: `# a` and `a` become `; a`.
[[nodiscard]] std::string remark_line(std::string_view text);

/// Puts `more` behind `remarks`.
void append(Remarks& remarks, const Remarks& more);

}  // namespace edsc
