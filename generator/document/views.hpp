/// The parts of the views for the templates in templates/document. A member without a value is null, so that the
/// template does not find that of an outer section.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "compare/change.hpp"
#include "document/document.hpp"

namespace edsc::document {

using Json = nlohmann::ordered_json;

/// Null for an empty text.
[[nodiscard]] inline Json shown(std::string_view text) { return text.empty() ? Json(nullptr) : Json(text); }

/// A row of a list of properties.
[[nodiscard]] inline Json property(std::string_view name, std::string_view value) {
  return {{"key", name}, {"value", value}};
}

/// Adds a property if it has a value.
inline void add_property(Json& rows, std::string_view name, std::string_view value) {
  if (!value.empty()) rows.push_back(property(name, value));
}

/// The name of a file as a relative URL.
[[nodiscard]] std::string url_of(std::string_view file_name);

/// `identity`, `services`, `file` and `commissioning`: lists of properties; `bit_rates`, with those not supported;
/// `network`: null, or that of the node.
void add_identity(const DeviceToDocument& input, Json& view);

/// `areas` of the object dictionary with their objects, and the choices of the filters.
void add_objects(const DeviceToDocument& device, Json& view);

/// What a raw number is multiplied by, and the unit: `× 0.1 °C`, `rpm`.
[[nodiscard]] std::string unit_text(const Quantity& quantity);

/// The meaning of objects as tables: names of values, drawn bits, states. Each meaning is drawn once, at the first
/// object that has it; others have a link to it.
class MeaningTables {
 public:
  explicit MeaningTables(const Device& device) : device_{device} {}

  [[nodiscard]] Json of(const Object& object);

 private:
  [[nodiscard]] Json view_of(const Object& object, const Meaning& meaning, const std::vector<const Entry*>& entries);

  const Device& device_;
  std::map<const Meaning*, std::string> drawn_;  ///< with the anchor of the entry
};

/// `error_codes` that the options of the device name, and `profile_codes` of the profiles.
void add_error_codes(const Device& device, Json& view);

/// `pdo_groups`, with the drawing of each PDO.
void add_pdos(const DeviceToDocument& input, Json& view);

/// `findings` and a sentence that counts them.
void add_findings(const Diagnostics& diagnostics, Json& view);

/// `changes` since another version, with a sentence that counts them.
void add_changes(const ComparedWith* compared, Json& view);

/// The identifier of an entry in the page: `6041h`, `1018h-01` with a sub-index.
[[nodiscard]] std::string anchor_of(const Object& object, const Entry& entry);

/// The line of a position; `5 of drive.eds` in an overlay and its bases.
[[nodiscard]] Json line_of(const Position& position);

/// The comment lines directly before a section of an EDS, without their semicolons and without those for edsc.
[[nodiscard]] std::string comment_before(const Position& section);

/// `every SYNC`, `event-driven (device profile)`.
[[nodiscard]] std::string transmission_text(std::uint64_t transmission_type);

/// At most `max` code points; the last one is an ellipsis if the text is longer.
[[nodiscard]] std::string shortened(std::string_view text, std::size_t max);

/// `topology`: the drawing; null if no node receives a PDO or SYNC of another one. `links`: the same as rows.
void add_topology(const Network& network, Json& view);

/// Boxes of the nodes, and arrows for their PDOs and SYNC.
[[nodiscard]] Json topology_drawing(const Network& network);

/// `sync`: the cycle of SYNC as a drawing; null without SYNC or bit rate. `messages`: load and response times.
void add_timing(const Network& network, Json& view);

/// The cycle of SYNC as in `sync` of `add_timing`.
[[nodiscard]] Json cycle_drawing(const Network& network);

}  // namespace edsc::document
