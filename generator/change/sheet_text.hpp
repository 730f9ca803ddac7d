/// The sections and entries of the text of an EDS or DCF by their lines, for edits of the text.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "eds/ini.hpp"
#include "eds/sections/section_name.hpp"
#include "text/source_file.hpp"

namespace edsc {

struct TextSection {
  SectionName name;
  std::string_view title;  ///< as written
  std::uint32_t line = 0;  ///< of the header
  std::uint32_t end = 0;   ///< the line of the next header, or one after the last line
};

class SheetText {
 public:
  explicit SheetText(const SourceFile& source);

  [[nodiscard]] const SourceFile& source() const { return source_; }
  [[nodiscard]] const std::vector<TextSection>& sections() const { return sections_; }

  /// The section with this name, or null. Names with the same index are equal: `1018sub1` and `1018sub01`. `occurrence`
  /// counts duplicate sections from 1.
  [[nodiscard]] const TextSection* find(std::string_view title, unsigned occurrence = 1) const;
  [[nodiscard]] const TextSection* find(const SectionName& name) const;

  /// The entries of a section.
  [[nodiscard]] std::vector<IniEntry> entries(const TextSection& section) const;
  /// The entry with this key, ignoring letter case; nothing if there is none.
  [[nodiscard]] std::optional<IniEntry> find_entry(const TextSection& section, std::string_view key,
                                                   unsigned occurrence = 1) const;
  /// The last line of a section that is a header or an entry, or a comment directly below one.
  [[nodiscard]] std::uint32_t last_line(const TextSection& section) const;
  /// The first line of the comment directly above a section, else its header.
  [[nodiscard]] std::uint32_t first_line(const TextSection& section) const;

  [[nodiscard]] bool is_blank_line(std::uint32_t line) const;

 private:
  using IdentityPlace = std::pair<std::uint64_t, std::uint32_t>;  ///< of a section

  const SourceFile& source_;
  std::vector<TextSection> sections_;
  std::vector<IdentityPlace> places_;  ///< sorted
};

/// The numbered entries of a list, such as [OptionalObjects], and the key that states their number.
struct ListRows {
  std::size_t count = 0;
  std::uint64_t last_number = 0;   ///< the highest one; 0 without entries
  std::optional<IniEntry> stated;  ///< SupportedObjects, NrOfEntries, ObjectLinks

  /// The key as written, else as usual for an object list.
  [[nodiscard]] std::string count_key() const;
};
[[nodiscard]] ListRows list_rows(const SheetText& text, const TextSection& list);

/// The key without `#N`, and N; 1 without it.
struct CountedName {
  std::string_view name;
  unsigned occurrence = 1;
};
[[nodiscard]] CountedName read_counted_name(std::string_view text);

}  // namespace edsc
