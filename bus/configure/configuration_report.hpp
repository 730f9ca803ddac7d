/// A configuration run as text, and as JSON (docs/schema/configure.schema.json).
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "configure/configuration_run.hpp"

namespace edsc {

/// `6083h:00 Profile acceleration: 1000 -> 2000`
[[nodiscard]] std::string change_text(const ConfigurationChange& change);

/// The same of a value that is not written; without a comparison `100Bh:00 Node-ID = 5`.
[[nodiscard]] std::string withheld_text(const ConfigurationRun& run, const ConfigurationChange& change);

/// `switch off  1400h:01 COB-ID`
[[nodiscard]] std::string step_text(const ConfigurationStep& step);

/// The value of the node: `1000`, `(write-only)` or `(cannot be read)`.
[[nodiscard]] std::string found_text(const ConfigurationChange& change);

/// The value that it shall have.
[[nodiscard]] std::string wanted_text(const ConfigurationChange& change);

/// `axis1.dcf:40:16: error: 6083h:00 Profile acceleration = 2000: refused by the device: ...`; `node`, such as
/// `node axis1 (5): `, is written before the entry.
[[nodiscard]] std::string failure_text(const ConfigurationFailure& failure, std::string_view node = {});

/// `node 5: 3 of 40 values differ; 3 of 3 values written, 3 verified`
[[nodiscard]] std::string summary_text(const ConfigurationRun& run);

[[nodiscard]] nlohmann::ordered_json as_json(const ConfigurationRun& run);

/// `index`, `sub_index`, `name` and `line` of a value.
[[nodiscard]] nlohmann::ordered_json entry_json(const LiveEntry& entry, const ConfigurationValue* value);

}  // namespace edsc
