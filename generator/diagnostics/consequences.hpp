/// Findings that follow from other findings.
#pragma once

#include "diagnostics/diagnostics.hpp"

namespace edsc {

/// Whether the findings of a file may follow from others by what they say of one object, so that
/// mark_consequences() needs its outline.
[[nodiscard]] bool needs_outline(const Diagnostics& diagnostics, const SourceFile& file);

/// Marks the findings of the outline's file that follow from another one by a row of `cause_rows`. A finding with
/// several places follows only if all of them do, and never from a finding that is less severe.
void mark_consequences(Diagnostics& diagnostics, const SheetOutline& outline);

}  // namespace edsc
