/// Reads the behaviour of a node from a JSON file: docs/schema/behaviour.schema.json.
#pragma once

#include "device/behaviour.hpp"
#include "diagnostics/diagnostics.hpp"
#include "lookup/find_entry.hpp"
#include "text/source_file.hpp"

namespace edsc {

/// Errors are in `diagnostics`, with their positions in the source. Actions are commands as on standard input.
[[nodiscard]] BehaviourScript read_behaviour_script(const SourceFile& source, EntryFinder& names,
                                                    Diagnostics& diagnostics);

}  // namespace edsc
