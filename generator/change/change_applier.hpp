/// Changes one after another, each on the text that the ones before it result in.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "change/change.hpp"
#include "change/sheet_edit.hpp"
#include "change/sheet_text.hpp"
#include "text/source_file.hpp"

namespace edsc {

class ChangeApplier {
 public:
  explicit ChangeApplier(std::shared_ptr<const SourceFile> source);

  /// Applies a change. Does nothing after a problem.
  void apply(const SheetChange& change);

  /// The text with all changes.
  [[nodiscard]] std::shared_ptr<const SourceFile> finish();

  /// Why a change is not possible; empty if all were.
  [[nodiscard]] const std::string& problem() const { return problem_; }
  /// Why changes should be rejected.
  [[nodiscard]] const std::vector<std::string>& objections() const { return objections_; }

 private:
  /// The text between two flushes, and the edits of it.
  struct Step {
    explicit Step(const SourceFile& source) : text(source), edit(text) { edit.append_to_lists(); }
    SheetText text;
    SheetEdit edit;
    std::set<std::pair<std::uint32_t, std::string>> added_keys;  ///< line of the section and key in lower case
    bool is_changed = false;
  };

  /// An entry of a mapping parameter that maps an object.
  struct MappedEntry {
    IniEntry entry;
    MappingValue value;
    std::uint16_t parameter = 0;
    bool is_active = true;  ///< within the number of mapped objects
  };

  void make(const SetValue& change);
  void make(const RemovePart& change);
  void make(const RenamePart& change);
  void make(const AddSections& change);
  void make(const MapPdo& change);
  void make(const AllowFinding& change);

  void flush();
  void reject(std::string problem);
  [[nodiscard]] const TextSection* find(std::string_view title);
  /// Returns a key of a section that a change names by this title, such as `Granularity#2`; rejects the change if it
  /// is missing.
  [[nodiscard]] std::optional<IniEntry> find_key(const TextSection& section, std::string_view title,
                                                 std::string_view key);
  void set(const TextSection& section, std::string_view key, std::string_view value);
  void set_existing(const TextSection& section, const IniEntry& entry, std::string_view value);
  /// Whether a value is a number in the notation of the file: not a text or a value of a string.
  [[nodiscard]] bool is_numeric(const TextSection& section, std::string_view key) const;
  void set_in_single(SectionKind kind, std::string_view key, std::string_view value);
  void follow_identity(const TextSection& section, std::string_view key, std::string_view value);
  void count_pdos(const std::vector<SectionName>& removed, const std::vector<SectionName>& added);
  [[nodiscard]] std::vector<MappedEntry> mapped_entries() const;
  [[nodiscard]] std::optional<std::uint64_t> number_of_mapped(std::uint16_t parameter) const;
  void follow_renamed(const SectionName& before, const SectionName& after);
  void check_unmapped(const SectionName& removed);

  void set_communication(const MapPdo& change, std::uint16_t index);
  void set_mapping(const MapPdo& change, std::uint16_t index);
  /// The same for an object with CompactSubObj: the values are in the list of the object.
  void set_compact_mapping(const MapPdo& change, std::uint16_t index, const IniEntry& compact);
  /// CompactSubObj of an object; nothing if it is missing or 0.
  [[nodiscard]] std::optional<IniEntry> compact_entries(std::uint16_t index) const;
  void use_dummies(const MapPdo& change);
  void set_or_add_sub(std::uint16_t index, std::uint8_t sub_index, NewSection section, std::string_view value);
  [[nodiscard]] bool is_dcf() const;
  /// `2000subA`, in the notation of the file.
  [[nodiscard]] std::string sub_title(std::uint16_t index, std::uint8_t sub_index) const;

  std::shared_ptr<const SourceFile> source_;
  std::unique_ptr<Step> step_;
  std::string problem_;
  std::vector<std::string> objections_;
};

}  // namespace edsc
