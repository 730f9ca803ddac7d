/// CAN-IDs and PDO layouts of a node, by its EDS and by what the log has written to it.
#pragma once

#include <canopen/can/cob_id.hpp>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "decode/value_format.hpp"
#include "device/device.hpp"
#include "device/options/options.hpp"
#include "pdo/mapping.hpp"

namespace edsc {

/// The place of an object in `NodeModel` on whose value fields of other objects depend.
using SelectorPlace = std::optional<std::uint8_t>;

/// An object in a PDO.
struct PdoField : PlacedObject {
  const Entry* entry = nullptr;                ///< null: a dummy, or an entry that does not exist
  const canopen::DataTypeRow* type = nullptr;  ///< null if neither is known
  std::string name = {};                       ///< `Statusword`
  ValueFormat format = {};                     ///< of a number with the length of its type
  bool is_formatted = false;                   ///< whether `format` applies
  SelectorPlace selects = {};                  ///< fields of other objects depend on this one
  SelectorPlace depends_on = {};               ///< fields of this object depend on that one
};

struct PdoLayout {
  PdoDirection direction = PdoDirection::receive;
  std::uint16_t number = 1;
  canopen::CobId cob_id;
  bool multiplexed = false;
  unsigned bits = 0;
  bool has_selectors = false;  ///< fields of objects depend on a value in it
  std::vector<PdoField> fields;
};

/// A pair of CAN-IDs that an SDO server uses.
struct SdoServerIds {
  canopen::CobId request;   ///< client to server
  canopen::CobId response;  ///< server to client
};

/// `Identity object, Vendor-ID`; the Denotation of a DCF, if present.
[[nodiscard]] std::string display_name(const Object& object, const Entry& entry);

class NodeModel {
 public:
  /// The device must outlive the model. Its formulas must be resolved for this node-ID.
  NodeModel(std::uint8_t node_id, const Device& device, std::uint32_t inhibit_time_unit = usual_inhibit_time_unit);

  [[nodiscard]] std::uint8_t node_id() const { return node_id_; }
  [[nodiscard]] const Device& device() const { return *device_; }
  /// Of PDOs, in microseconds.
  [[nodiscard]] std::uint32_t inhibit_time_unit() const { return inhibit_time_unit_; }
  [[nodiscard]] const std::vector<PdoLayout>& pdos() const { return pdos_; }
  /// Not valid if the node does not have the service.
  [[nodiscard]] canopen::CobId sync() const { return cob_id(0x1005); }
  [[nodiscard]] canopen::CobId time() const { return cob_id(0x1012); }
  [[nodiscard]] canopen::CobId emcy() const { return cob_id(0x1014); }
  /// The servers from 1201h on; every node has the default SDO.
  [[nodiscard]] std::vector<SdoServerIds> further_sdo_servers() const;

  /// The last value, since the boot-up, of the object on which fields of an entry depend: 6061h for 6041h. Nothing if
  /// the log does not have one, and for other entries.
  [[nodiscard]] std::optional<std::int64_t> selector_of(const Entry& entry) const;
  [[nodiscard]] std::optional<std::int64_t> selector(SelectorPlace place) const {
    return place ? selectors_[*place].value : std::nullopt;
  }
  /// A PDO has a value of an object on which fields depend.
  void select(std::uint8_t place, std::uint64_t number);

  /// The value in force of a COB-ID, mapping or timing parameter: of the EDS, or as written or read in the log. Empty
  /// if neither states one.
  [[nodiscard]] std::optional<std::uint32_t> parameter(std::uint16_t index, std::uint8_t sub_index) const;

  /// `Statusword, 16 bits`: the meaning of a value of a mapping parameter.
  [[nodiscard]] std::string mapped_name(std::uint32_t mapping) const;

  /// An SDO has written or read a value, low byte first. Returns true if CAN-IDs or layouts have changed.
  [[nodiscard]] bool learn(std::uint16_t index, std::uint8_t sub_index, std::span<const std::uint8_t> value,
                           bool written);

  /// The node has been reset, which discards values that were not stored. Returns true if CAN-IDs or layouts have
  /// changed.
  [[nodiscard]] bool reset();

 private:
  using Key = std::uint32_t;
  using Parameters = std::map<Key, std::uint32_t>;

  [[nodiscard]] canopen::CobId cob_id(std::uint16_t index, std::uint8_t sub_index = 0) const;
  [[nodiscard]] PdoField field(const PlacedObject& mapped) const;
  [[nodiscard]] SelectorPlace selector_place(std::uint16_t index, std::uint8_t sub_index) const;
  void find_selectors();
  void lay_out(std::size_t pdo);
  void lay_out_all();

  std::uint8_t node_id_;
  const Device* device_;
  std::uint32_t inhibit_time_unit_;
  /// An object on whose value fields of other objects depend.
  struct Selector {
    const Entry* entry;
    std::optional<std::int64_t> value;
  };
  std::vector<Selector> selectors_;
  std::vector<PdoLayout> pdos_;  ///< in the order of the device
  Parameters written_;           ///< values that differ from the EDS
  Parameters stored_;            ///< those of them that remain after a reset
};

}  // namespace edsc
