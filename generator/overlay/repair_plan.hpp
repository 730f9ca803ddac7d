/// An overlay from the remedies of findings.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "change/sheet_text.hpp"
#include "diagnostics/remedy.hpp"
#include "overlay/write_overlay.hpp"

namespace edsc {

/// Collects remedies. Those of a fault of the whole file come first: what follows from it may be wrong.
class RepairPlan {
 public:
  /// `base` is the text that the overlay changes. It must outlive the plan.
  explicit RepairPlan(const SourceFile& base) : base_{base} {}

  /// Adds the remedies of the base, or of the base with the overlay so far. Returns whether the overlay has changed.
  bool add(const std::vector<Remedy>& remedies);

  [[nodiscard]] bool empty() const { return changes_.empty() && header_.empty() && unlisted_.empty(); }
  /// The number of changed, added and listed values of each rule.
  [[nodiscard]] const std::map<RuleId, std::size_t>& counts() const { return counts_; }
  /// Remarks and the path of the base are left to the caller.
  [[nodiscard]] NewOverlay overlay() const;

 private:
  struct Unlisted {
    std::string list;
    std::string reason;
  };

  bool add(const Remedy& remedy);
  bool add_value(const Remedy& remedy);
  void add_lists(NewOverlay& overlay) const;
  [[nodiscard]] const SheetText& text_of(const SourceFile& file);

  SheetText base_;
  std::map<const SourceFile*, std::unique_ptr<SheetText>> texts_;
  std::vector<OverlayChange> changes_;
  std::map<std::pair<std::string, std::string>, std::size_t> places_;  ///< by section and key: index in `changes_`
  std::vector<std::pair<std::string, std::string>> header_;
  std::map<std::string, Unlisted> unlisted_;  ///< by the text of the index
  std::map<RuleId, std::size_t> counts_;
};

}  // namespace edsc
