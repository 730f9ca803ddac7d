/// Declared deviations: where a device does not do what CiA 301 says, on purpose, and what its manual says about it.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "conform/verdict.hpp"
#include "diagnostics/diagnostics.hpp"
#include "text/source_file.hpp"
#include "values/find_entry.hpp"

namespace edsc::conform {

struct Deviation {
  std::string id;                      ///< of the case: `3.7`
  std::optional<EntryAddress> object;  ///< the deviation is of this object or entry only
  std::string reason;
  std::string source;  ///< `manual, page 12`; may be empty
  Position position;   ///< in the file, which must outlive this
};

/// Reads a file as docs/schema/deviations.schema.json says. Anything else in it is an error, at its line and column.
[[nodiscard]] std::vector<Deviation> read_deviations(const SourceFile& source, Diagnostics& diagnostics);

/// A failed case that is declared becomes `deviates`. A declaration with an object does not apply to a failure that
/// names other entries only.
void apply_deviations(std::span<const Deviation> deviations, CaseResult& result);

/// Fills `unused_deviations`: declarations whose case has passed.
void find_unused_deviations(std::span<const Deviation> deviations, RunReport& run);

}  // namespace edsc::conform
