/// Changes that remove the causes of findings: for editors, and for the page of `edsc edit`.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "change/change.hpp"
#include "change/sheet_text.hpp"
#include "device/device.hpp"
#include "diagnostics/diagnostics.hpp"

namespace edsc {

struct Fix {
  std::string title;  ///< `Change to 3, the number of entries`
  std::vector<SheetChange> changes;
  bool needs_reason = false;  ///< the change is an AllowFinding whose reason the user has to state
};

/// Finds the fixes of the findings of a text: what a standard or the rest of the file states, and what is usually
/// meant.
class Fixes {
 public:
  /// `device`: what the text describes; null if it describes none. All must outlive the object.
  Fixes(const SheetText& text, const Diagnostics& diagnostics, const Device* device);

  /// The fixes of a finding of this rule in a line of the text, the best one first.
  [[nodiscard]] std::vector<Fix> at(RuleId rule, std::uint32_t line) const;
  /// A comment that allows the finding; nothing if no comment can.
  [[nodiscard]] std::optional<Fix> allowance(RuleId rule, std::uint32_t line) const;
  /// All object lists and counts, which follow from the rest of the file.
  [[nodiscard]] std::vector<SheetChange> of_lists_and_counts() const;

  /// The section with a line; null before the first one.
  [[nodiscard]] const TextSection* section_at(std::uint32_t line) const;

 private:
  struct Place;
  struct Row;
  static const std::vector<Row>& rows();

  [[nodiscard]] std::optional<Place> place_at(std::uint32_t line) const;
  [[nodiscard]] std::optional<Fix> of_remedy(const Remedy& remedy) const;
  [[nodiscard]] std::optional<Fix> of_listing(const Remedy& remedy) const;

  // Fixes of the rules in the table.
  [[nodiscard]] std::vector<Fix> count_entries(const Place& place) const;
  [[nodiscard]] std::vector<Fix> remove_line(const Place& place) const;
  [[nodiscard]] std::vector<Fix> correct_key(const Place& place) const;
  [[nodiscard]] std::vector<Fix> change_access(const Place& place) const;
  template <std::uint8_t sub_index>
  [[nodiscard]] std::vector<Fix> copy_identity(const Place& place) const;

  const SheetText& text_;
  const Diagnostics& diagnostics_;
  const Device* device_;
  std::unordered_multimap<std::uint32_t, const Remedy*> remedies_;  ///< by line of the text
};

}  // namespace edsc
