/// Findings that a comment in the EDS or the options file allows, each with a reason.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "diagnostics/position.hpp"
#include "rules/rule.hpp"

namespace edsc {

/// A part of a data sheet: a section, an XML element, or one line of it.
struct SheetPart {
  std::uint32_t line = 0;
  std::uint32_t column = 0;
  std::optional<std::uint16_t> index = {};     ///< of the described object
  std::optional<std::uint8_t> sub_index = {};  ///< of its entry; 0 for the section of an object
};

/// The positions of the parts of a data sheet.
struct SheetOutline {
  const SourceFile* file = nullptr;
  std::vector<SheetPart> parts;  ///< in order; each ends where the next one begins
  std::vector<SheetPart> lines;  ///< lines that describe another object or entry than their part
};

/// The index of the object that a position of the file describes, if it is one of an object.
[[nodiscard]] std::optional<std::uint16_t> object_at(const SheetOutline& outline, const Position& position);

/// The scope of an allowance.
struct AllowanceScope {
  enum class Kind : std::uint8_t { file, part, line, object, entry };

  Kind kind = Kind::file;
  std::uint32_t line = 0;  ///< of `part`: its first line
  std::uint16_t index = 0;
  std::uint8_t sub_index = 0;

  auto operator<=>(const AllowanceScope&) const = default;
};

struct Allowance {
  RuleId rule;
  std::string reason;
  Position position;       ///< of the allowance itself
  bool in_source = false;  ///< a comment in the EDS; otherwise a member of the options file
  AllowanceScope scope;
  std::size_t findings = 0;  ///< number of findings that it applied to
};

/// The allowances of one data sheet.
class Allowances {
 public:
  void set_outline(SheetOutline outline);
  [[nodiscard]] const SheetOutline& outline() const { return outline_; }
  void add(Allowance allowance);

  /// The index in `all()` of the first allowance of `rule` that applies to `position`, narrowest scope first.
  [[nodiscard]] std::optional<std::size_t> find(RuleId rule, const Position& position) const;
  void count_finding(std::size_t allowance) { ++all_[allowance].findings; }

  [[nodiscard]] const std::vector<Allowance>& all() const { return all_; }

 private:
  struct Key {
    RuleId rule;
    AllowanceScope scope;
    auto operator<=>(const Key&) const = default;
  };

  [[nodiscard]] std::optional<std::size_t> find(RuleId rule, const AllowanceScope& scope) const;
  [[nodiscard]] std::optional<std::size_t> find_object(RuleId rule, const SheetPart& part) const;

  SheetOutline outline_;
  std::vector<Allowance> all_;
  std::map<Key, std::size_t> places_;
};

}  // namespace edsc
