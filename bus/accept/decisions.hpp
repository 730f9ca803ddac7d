/// Decides by evidence alone whether the EDS or the device is wrong. Frames do not show intent: a difference that
/// neither CiA 301, nor a contradiction within the EDS or the device decides is undecided.
#pragma once

#include <canopen/can/node_id.hpp>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "accept/dictionary_reader.hpp"
#include "accept/difference.hpp"
#include "device/device.hpp"
#include "eds/data_sheet.hpp"

namespace edsc::accept {

/// A difference, and all that its decision may use.
struct Facts {
  const Device& sheet;
  const DataSheet& data;  ///< the EDS as written
  canopen::NodeId node;
  const Readings& readings;
  Kind kind;
  const Reading& reading;
  const Object* object = nullptr;  ///< null if the EDS does not have it

  [[nodiscard]] std::uint16_t index() const { return reading.entry.index; }
  [[nodiscard]] std::uint8_t sub_index() const { return reading.entry.sub_index; }
  /// The device has an entry of this object.
  [[nodiscard]] bool device_has(std::uint16_t index) const;
};

/// The first row of its kind that applies decides; the last row of each kind always applies.
struct Decision {
  Kind kind;
  std::string_view id;        ///< in JSON: `mandatory-object`
  std::string_view evidence;  ///< in the documents
  Mark mark;
  bool (*applies)(const Facts& facts);
  std::string_view reason;  ///< with {entry}, {object}, {clause}, {standard}, {eds}, {device}, {other}
  /// The keys with which the EDS would describe the device; null: none.
  std::vector<Correction> (*correct)(const Facts& facts) = nullptr;
};

[[nodiscard]] std::span<const Decision> decisions();

/// Sets mark, evidence, reason and corrections of a difference, whose other members are known.
void decide(const Facts& facts, Difference& difference);

/// Whether sub-index 0 of the object is the highest sub-index, and not a number of errors or mapped objects.
[[nodiscard]] bool states_highest_sub_index(const Object& object);
/// Sub-index 0 as written in the EDS: edsc itself uses the highest sub-index described.
[[nodiscard]] std::optional<std::uint64_t> written_count(const DataSheet& data, const Object& object);
/// The COB-ID of the pre-defined connection set, if the entry has one and the EDS states another CAN-ID.
[[nodiscard]] std::optional<std::uint32_t> other_predefined_cob_id(const DataSheet& data, const Entry& entry,
                                                                   canopen::NodeId node);
/// The value of DefaultValue, or of ParameterValue in a DCF, as written.
[[nodiscard]] std::optional<std::string> written_value(const DataSheet& data, const Object& object,
                                                       std::uint8_t sub_index);

}  // namespace edsc::accept
