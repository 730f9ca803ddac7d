/// Compares COB-IDs by meaning: CAN-ID and flags (CiA 301, 7.5.2.5 to 7.5.2.37).
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
  ChangeId id;
  std::string old_value;  ///< the CAN-ID if it changed, else the whole COB-ID
  std::string new_value;
};

/// The changes between two COB-IDs of a service, except bit 31 of a PDO, which is a change of the PDO. No change is
/// breaking if the service did not exist before.
[[nodiscard]] std::vector<CobIdChange> compare_cob_ids(const std::optional<Value>& before,
                                                       const std::optional<Value>& after,
                                                       const canopen::DataTypeRow& type, CobIdService service);

}  // namespace edsc
