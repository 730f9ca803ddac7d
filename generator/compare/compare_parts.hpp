/// Comparisons of the parts of two versions of a device.
#pragma once

#include <canopen/od/data_type.hpp>
#include <optional>
#include <string>
#include <vector>

#include "compare/change.hpp"
#include "device/cob_id_parameter.hpp"
#include "device/device.hpp"

namespace edsc {

struct CobIdChange {
  ChangeRule rule;
  std::string old_value;  ///< the CAN-ID if it changed, else the whole COB-ID
  std::string new_value;
};

/// The changes between two COB-IDs of a service, except bit 31 of a PDO, which is a change of the PDO. No change is
/// breaking if the service did not exist before.
[[nodiscard]] std::vector<CobIdChange> compare_cob_ids(const std::optional<Value>& before,
                                                       const std::optional<Value>& after,
                                                       const canopen::DataTypeRow& type, CobIdService service);

/// Compares type, access, mapping, limits and default value. `in_rpdo`: an RPDO maps the entry by default, so that its
/// limits apply to the sender too. The default values of PDO communication and mapping parameters are compared as PDOs.
void compare_entries(const Entry& before, const Entry& after, bool in_rpdo, Changes& changes);

/// A value in EDS spelling; strings in quotes; `none` if missing.
[[nodiscard]] std::string value_text(const std::optional<Value>& value, const canopen::DataTypeRow& type);

[[nodiscard]] bool same_value(const std::optional<Value>& a, const std::optional<Value>& b);

void compare_pdos(const Device& before, const Device& after, Changes& changes);

/// Whether the object holds the communication or mapping parameter of a PDO (1400h..1BFFh).
[[nodiscard]] bool is_pdo_parameter(std::uint16_t index);

}  // namespace edsc
