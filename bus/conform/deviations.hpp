/// Declared deviations: intended differences of a device from CiA 301, with the reason and the place in its manual.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "conform/verdict.hpp"
#include "diagnostics/diagnostics.hpp"
#include "lookup/find_entry.hpp"
#include "text/source_file.hpp"

namespace edsc::conform {

struct Deviation {
  std::string id;                      ///< of the case: `3.7`
  std::optional<EntryAddress> object;  ///< restricts the deviation to this object or entry
  std::string reason;
  std::string source;    ///< `manual, page 12`; may be empty
  Position position;     ///< in the SourceFile, which must outlive this
  bool is_used = false;  ///< it covers a difference of the object dictionary or of the identity
};

/// A member of a declaration in the file. Each is a text.
struct DeviationMember {
  std::string_view name;
  bool is_required;
  std::string_view pattern;  ///< of the text, in docs/schema/deviations.schema.json
  std::string_view meaning;
  /// Sets the member of the declaration. Returns what is wrong with the text, or nothing.
  std::string (*set)(Deviation& deviation, const std::string& text);
};

[[nodiscard]] std::span<const DeviationMember> deviation_members();

/// Reads a file in the format of docs/schema/deviations.schema.json. Reports anything else in it as an error, with line
/// and column.
[[nodiscard]] std::vector<Deviation> read_deviations(const SourceFile& source, Diagnostics& diagnostics);

/// Sets the verdict of a failed case with a declaration to `deviates`. A declaration with an object does not apply to a
/// failure that names only other entries. If the case tries many entries, each that failed must be declared.
void apply_deviations(std::span<const Deviation> deviations, CaseResult& result);

/// Declares the differences of the identity if deviations of the case that compares these constants cover each of them.
void apply_deviations(std::span<Deviation> deviations, RunReport& run);

/// Fills `unused_deviations` with the declarations whose case passed, unless they cover another difference.
void find_unused_deviations(std::span<const Deviation> deviations, RunReport& run);

/// The reason with its source: `at every SYNC (manual, page 12)`.
[[nodiscard]] std::string reason_of(const Deviation& deviation);

}  // namespace edsc::conform
