/// PDO parameters that change only while the PDO is not valid, in PDOs that a master cannot disable.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "device/device.hpp"
#include "device/options/options.hpp"

namespace edsc {

/// A parameter that CiA 301 lets change only while bit 31 of the COB-ID is set, and the option that removes this
/// condition.
struct ConditionalParameter {
  std::string_view name;    ///< `mapping`
  std::string_view option;  ///< member of canopen::DeviceOptions
  /// The writable entry of a PDO; null if it has none.
  const Entry* (*entry_of)(const Pdo& pdo);
};

[[nodiscard]] std::span<const ConditionalParameter> conditional_parameters();

/// A writable parameter of a PDO that is valid by default and whose COB-ID cannot be written.
struct LockedParameter {
  const Pdo* pdo;
  const Entry* entry;
  const Entry* cob_id;
};

/// The PDOs in which the parameter is locked.
[[nodiscard]] std::vector<LockedParameter> locked_in(const Device& device, const ConditionalParameter& parameter);

/// Whether the option of a parameter is implied: the parameter is locked in some PDOs, and no other PDO that has it can
/// be disabled.
[[nodiscard]] bool is_implied(const Device& device, const ConditionalParameter& parameter);

/// Sets the options without which a device could never accept a write of a parameter (`is_implied`), unless the options
/// file states them. A warning states it.
void imply_options(const Device& device, Options& options, Diagnostics& diagnostics);

}  // namespace edsc
