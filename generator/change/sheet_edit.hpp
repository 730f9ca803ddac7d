/// Changes of an EDS or DCF as edits of its lines: keys, sections and objects, with the object lists, their counts,
/// SubNumber and sub-index 0 that follow from them.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "change/sheet_text.hpp"
#include "change/text_edit.hpp"

namespace edsc {

/// Where a new value is from: the columns of its key and of the value in that line.
struct ValueOrigin {
  const SourceFile* file = nullptr;
  std::uint32_t line = 0;
  std::uint32_t key_column = 1;
  std::uint32_t value_column = 1;
};

class SheetEdit {
 public:
  explicit SheetEdit(const SheetText& text) : text_(text) {}

  /// New objects are added at the end of a list, also of an ascending one.
  void append_to_lists() { appends_to_lists_ = true; }

  /// A comment after a number remains, unless `with_comment`.
  void set_value(const IniEntry& entry, std::string_view value, const ValueOrigin& origin, bool with_comment = false);
  /// Adds lines before the first one.
  void add_lines_at_start(std::vector<NewLine> lines);
  /// Adds comments before the line of an entry or section.
  void add_comments(std::uint32_t line, std::vector<NewLine> comments);
  void remove_entry(const IniEntry& entry);
  /// Renames a key. Its value remains.
  void rename_entry(const IniEntry& entry, std::string_view key);
  /// The entry remains as it is, also if other changes would adapt it.
  void keep_entry(const IniEntry& entry) { touched_.insert(entry.line); }
  /// Adds a key at its place in the canonical order of the section. `lines` are comments before it and its line.
  void add_entry(const TextSection& section, std::string_view key, std::vector<NewLine> lines);
  /// Whether a change of this entry was already requested.
  [[nodiscard]] bool is_touched(const IniEntry& entry) const { return touched_.contains(entry.line); }

  /// Removes a section; that of an object with its other sections.
  void remove_section(const TextSection& section);
  /// Removes the lines of one section, without the changes that follow from it.
  void remove_lines(const TextSection& section);
  /// Renames a section; that of an object with its other sections. `name` is its new index, or index and sub-index.
  void rename_section(const TextSection& section, std::string_view name, const LineOrigin& origin);
  /// Adds a section at its place in the canonical order. `lines` are comments before it, its header and its keys.
  void add_section(const SectionName& name, std::vector<NewLine> lines);

  /// Names of sections that the result has more than once because of these changes.
  [[nodiscard]] std::vector<std::string> duplicate_sections() const;

  /// All edits, with the changes that follow from them: an object list that has a changed entry, and other entries that
  /// were changed or kept, are not adapted.
  [[nodiscard]] std::vector<TextEdit> finish();

 private:
  struct LineEdit {
    bool is_removed = false;
    std::optional<NewLine> replacement;
    std::vector<NewLine> before;
  };
  struct AddedSection {
    SectionName name;
    std::vector<NewLine> lines;
  };
  struct AddedEntry {
    const TextSection* section;
    std::string key;
    std::vector<NewLine> lines;
  };
  /// The sections of an object, before or after the changes.
  struct ObjectSections {
    bool has_section = false;
    std::set<std::uint8_t> sub_indices;
  };
  using Objects = std::map<std::uint16_t, ObjectSections>;

  [[nodiscard]] std::size_t place_of(const TextSection& section) const;
  [[nodiscard]] bool is_removed(const TextSection& section) const { return removed_.contains(place_of(section)); }
  [[nodiscard]] SectionName name_after(const TextSection& section) const;
  static void add_section_of(const SectionName& name, const std::set<std::uint16_t>& changed, Objects& objects);
  /// The objects whose sections change.
  [[nodiscard]] std::set<std::uint16_t> changed_objects() const;
  [[nodiscard]] Objects objects_before(const std::set<std::uint16_t>& changed) const;
  [[nodiscard]] Objects objects_after(const std::set<std::uint16_t>& changed) const;

  void replace_value(const IniEntry& entry, std::string_view value, bool with_comment = false);
  void replace_key(const IniEntry& entry, std::string_view key);
  void renew_lists(const Objects& before, const Objects& after);
  void renew_list(SectionKind list, const std::set<std::uint16_t>& removed, const std::set<std::uint16_t>& added);
  void add_list(SectionKind list, const std::set<std::uint16_t>& objects);
  [[nodiscard]] bool is_list_touched(const TextSection& list) const;
  void renew_sub_indices(const Objects& before, const Objects& after);
  void insert_sections();
  void insert_entries();
  void trim_end();
  [[nodiscard]] bool separates_by_blank_line() const;

  const SheetText& text_;
  std::map<std::uint32_t, LineEdit> lines_;
  std::set<std::uint32_t> touched_;
  std::set<std::size_t> removed_;  ///< places of sections
  bool has_removed_lines_ = false;
  bool appends_to_lists_ = false;
  std::map<std::size_t, SectionName> renamed_;
  std::vector<AddedSection> added_sections_;
  std::vector<AddedEntry> added_entries_;
};

/// A number with the base, digits and letter case of another one: 7 as `0x07` like `0x06`.
[[nodiscard]] std::string spelled_like(std::uint64_t number, std::string_view like);

}  // namespace edsc
