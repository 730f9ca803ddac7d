/// Changes of an EDS or DCF as plain data, and their JSON form.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "pdo/mapping.hpp"

namespace edsc {

/// Sets the value of a key; adds the key if the section does not have it. A number keeps the notation that it has in
/// the file. This is also the change of [FileInfo] and [DeviceInfo]: VendorNumber, ProductNumber and RevisionNumber are
/// set in 1018h too, and the other way round.
struct SetValue {
  std::string section;  ///< `2000`, `2000sub1`, `DeviceInfo`; in any spelling that a file may have
  std::string key;
  std::string value;

  friend bool operator==(const SetValue&, const SetValue&) = default;
};

/// Removes a key, or without one a section; the section of an object with its other sections.
struct RemovePart {
  std::string section;
  std::string key;  ///< empty: the section; `Granularity#2`: the second one with this name

  friend bool operator==(const RemovePart&, const RemovePart&) = default;
};

/// Renames a key, or without one a section. An object moves with its other sections; the PDOs that map it, and object
/// links, follow.
struct RenamePart {
  std::string section;
  std::string key;   ///< empty: the section
  std::string name;  ///< new key, or new title: `2010`, `2010sub1`

  friend bool operator==(const RenamePart&, const RenamePart&) = default;
};

/// A section with its keys, in any order.
struct NewSection {
  std::string title;
  std::vector<std::pair<std::string, std::string>> keys;

  friend bool operator==(const NewSection&, const NewSection&) = default;
};

/// Adds sections: objects, with their sub-objects, or other ones. The object lists follow.
struct AddSections {
  std::vector<NewSection> sections;

  friend bool operator==(const AddSections&, const AddSections&) = default;
};

/// Sets the parameters of a PDO, and adds their objects if they are missing. What has no value remains. In a DCF, the
/// values are ParameterValues.
struct MapPdo {
  PdoDirection direction = PdoDirection::transmit;
  std::uint16_t number = 1;                          ///< 1..512
  std::optional<std::vector<MappingValue>> objects;  ///< in the order of the frame; dummies too
  std::optional<std::string> cob_id;                 ///< `$NODEID+0x180`, `0x80000000`
  std::optional<std::uint8_t> transmission_type;
  std::optional<std::uint16_t> inhibit_time;  ///< in the unit of the object, usually 100 us
  std::optional<std::uint16_t> event_timer;   ///< in ms
  std::optional<std::uint8_t> sync_start;

  friend bool operator==(const MapPdo&, const MapPdo&) = default;
};

/// Adds a comment that allows the findings of a rule: `; edsc: allow RULE - reason`.
struct AllowFinding {
  std::string section;
  std::string key;  ///< as in RemovePart; empty: the section
  std::string rule;
  std::string reason;

  friend bool operator==(const AllowFinding&, const AllowFinding&) = default;
};

using SheetChange = std::variant<SetValue, RemovePart, RenamePart, AddSections, MapPdo, AllowFinding>;

/// A change as JSON: `{"do": "set", "section": "2000", "key": "DefaultValue", "value": "5"}`. Members without a value
/// are omitted.
[[nodiscard]] nlohmann::ordered_json change_as_json(const SheetChange& change);

/// The change of a JSON value; nothing for an unknown or missing member or an invalid value, which `problem` names.
[[nodiscard]] std::optional<SheetChange> read_change(const nlohmann::json& value, std::string& problem);

/// The change for people: `map 6041h:00 to TPDO 1`, `remove 2010h`.
[[nodiscard]] std::string change_text(const SheetChange& change);

}  // namespace edsc
