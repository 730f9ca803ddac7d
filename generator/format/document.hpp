/// An INI file for output: sections and entries with the comments before them.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "eds/ini.hpp"
#include "eds/sections/section_name.hpp"

namespace edsc {

/// Each line of a comment, with its `;`.
using Remarks = std::vector<std::string>;

struct DocumentEntry {
  Remarks remarks;  ///< before it
  std::string key;
  std::string value;

  friend bool operator==(const DocumentEntry&, const DocumentEntry&) = default;
};

struct DocumentSection {
  Remarks remarks;   ///< before it
  SectionName kind;  ///< the meaning of its title
  std::string title;
  Remarks header;  ///< comments for edsc on its line: before the first section they would apply to the file
  std::vector<DocumentEntry> entries;
};

struct Document {
  Remarks head;  ///< at the top, separated from the first section by a blank line
  std::vector<DocumentSection> sections;
  Remarks tail;  ///< after the last entry
};

/// The complete file, in its order. Comments that begin with `#`, and lines that are neither section nor entry, become
/// `;` comments.
[[nodiscard]] Document document_of(const IniFile& ini);

/// The same, each section changed by `change`. Nothing is read after a section for which it returns false.
[[nodiscard]] Document document_of(const IniFile& ini, const std::function<bool(DocumentSection&)>& change);

/// With LF, one blank line between sections, no blanks around `=`.
[[nodiscard]] std::string to_text(const Document& document);

/// `text` as a line of a comment: `# a` and `a` become `; a`.
[[nodiscard]] std::string remark_line(std::string_view text);

/// To be called before another section becomes the first: comments for edsc before this one apply to the file and move
/// to the top, those on its line move before it.
void give_up_first_place(Document& document);

/// To be called when another section has become the first: comments for edsc before it move to its line.
void take_first_place(Document& document);

/// Appends `more` to `remarks`.
void append(Remarks& remarks, const Remarks& more);

}  // namespace edsc
