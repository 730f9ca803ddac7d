/// The COB-IDs in the object dictionary and their default values in CiA 301, one row per kind of object.
#pragma once

#include <canopen/can/cob_id.hpp>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "device/device.hpp"

namespace edsc {

enum class CobIdService : std::uint8_t { sync, time, emcy, emcy_consumer, sdo_server, sdo_client, rpdo, tpdo };

/// A COB-ID of one object, or of a range of objects.
struct CobIdParameter {
  std::uint16_t first, last;  ///< indices
  std::uint8_t first_sub_index, last_sub_index;
  CobIdService service;
  bool has_valid_bit;        ///< bit 31: does not exist
  std::uint32_t predefined;  ///< of `first`: the pre-defined connection set (7.3.5), or bit 31 alone
  std::uint16_t step;        ///< from one index to the next
  bool plus_node_id;         ///< the node-ID is added to `predefined`
  std::string_view clause;   ///< of CiA 301

  [[nodiscard]] std::uint32_t predefined_of(std::uint16_t index) const {
    return predefined + std::uint32_t{step} * (index - first);
  }
};

/// All rows, ascending by index.
[[nodiscard]] std::span<const CobIdParameter> cob_id_parameters();

/// The row of an entry; null if the entry is not a COB-ID.
[[nodiscard]] const CobIdParameter* find_cob_id_parameter(std::uint16_t index, std::uint8_t sub_index);

/// The default COB-ID of the object at `index` by CiA 301. A known node-ID is added to it.
[[nodiscard]] Value predefined_cob_id(const CobIdParameter& parameter, std::uint16_t index,
                                      std::optional<std::uint8_t> node_id, const Position& position);

}  // namespace edsc
