/// What the page of `edsc edit` shows of a network file, as parts in JSON: docs/schema/edit.schema.json.
#pragma once

#include "diagnostics/diagnostics.hpp"
#include "edit/edit_parts.hpp"
#include "json/json_ranges.hpp"
#include "network/network.hpp"

namespace edsc::edit {

/// `network` and `entries`; `ranges`: the text of the network file, which is a JSON object; null if it is not.
void add_network(const Network& network, const JsonRanges* ranges, EditParts& parts);

/// `findings`
void add_network_findings(const SourceFile& source, const JsonRanges* ranges, const Diagnostics& diagnostics,
                          EditParts& parts);

/// A finding with the pointer of the member that it is at; one of another file has its name and line in its message.
[[nodiscard]] Json network_finding_json(const SourceFile& source, const JsonRanges* ranges, const Diagnostic& one);

}  // namespace edsc::edit
