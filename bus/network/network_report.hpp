/// The comparison and configuration of a network as text, and as JSON (docs/schema/network_verify.schema.json,
/// docs/schema/network_apply.schema.json).
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "network/network_session.hpp"

namespace edsc {

/// The values that differ from those of the node. A value that cannot be read differs; a write-only one does not.
[[nodiscard]] std::vector<const ConfigurationChange*> differences(const LiveNode& live);

/// Whether the node answers, is the device of its file, and has all its values.
[[nodiscard]] bool is_same(const LiveNode& live);

/// `vendor-ID, product code`: the numbers of the identity that the file or a node that was compared does not state.
[[nodiscard]] std::string identity_not_compared(const LiveNode& live);

/// Another minor revision: the node counts as the device of its file, but 1F87h of a master is compared completely.
/// Empty for the same revision.
[[nodiscard]] std::string other_minor_revision(const LiveNode& live);

/// `plant.json:7:5: error: node axis3 (7) does not answer`
[[nodiscard]] std::string problem_text(const NodeProblem& problem);

/// Lines for a node: what differs, or that nothing does.
[[nodiscard]] std::vector<std::string> verify_lines(const LiveNode& live);

/// `2 of 3 nodes are as in plant.json`
[[nodiscard]] std::string verify_summary(const std::vector<LiveNode>& nodes, const std::string& file);

[[nodiscard]] nlohmann::ordered_json verify_json(const std::vector<LiveNode>& nodes);

/// `3 of 3 nodes configured, started`
[[nodiscard]] std::string apply_summary(const std::vector<LiveNode>& nodes);

[[nodiscard]] nlohmann::ordered_json apply_json(const std::vector<LiveNode>& nodes);

}  // namespace edsc
