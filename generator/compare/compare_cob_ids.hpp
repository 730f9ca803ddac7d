/// COB-IDs compared by what they mean: a CAN-ID and flags (CiA 301, 7.5.2.5 to 7.5.2.37).
#pragma once

#include <canopen/data_type.hpp>
#include <optional>
#include <string>
#include <vector>

#include "compare/change.hpp"
#include "device/cob_id_parameter.hpp"
#include "device/device.hpp"

namespace edsc {

struct CobIdChange {
  ChangeId id;
  std::string old_value;  ///< the CAN-ID where that changed, else the whole COB-ID
  std::string new_value;
};

/// What changed from one COB-ID of a service to another. Whether a PDO exists (bit 31) is not part of it: that is a
/// change of the PDO. Nothing breaks anybody where the service does not exist before.
[[nodiscard]] std::vector<CobIdChange> compare_cob_ids(const std::optional<Value>& before,
                                                       const std::optional<Value>& after,
                                                       const canopen::DataTypeRow& type, CobIdService service);

}  // namespace edsc
