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

/// The sources of meanings that are compared. Options, and the profile that they can replace, only if both versions
/// have options that name something: a DCF without an options file is compared with its EDS by what both files state.
/// The profile only if it is the same: otherwise the device type has changed.
struct ComparedSources {
  bool options, profile;

  [[nodiscard]] bool has(MeaningSource source) const {
    return source == MeaningSource::eds || (source == MeaningSource::options ? options : profile);
  }
};
[[nodiscard]] ComparedSources compared_sources(const Device& before, const Device& after);

struct MeaningContext {
  bool in_pdo;  ///< a PDO maps the entry by default
  ComparedSources sources;
};

/// Compares units, names of values and bits.
void compare_meanings(const Entry& before, const Entry& after, const MeaningContext& context, Changes& changes);

/// Compares the names of error codes of EMCY messages.
void compare_error_codes(const Device& before, const Device& after, const ComparedSources& sources, Changes& changes);

/// A value in EDS spelling, and its meaning: `215 (21.5 °C)`, `1 run`.
[[nodiscard]] std::string meant_value_text(const std::optional<Value>& value, const Entry& entry);

[[nodiscard]] bool same_value(const std::optional<Value>& a, const std::optional<Value>& b);

void compare_pdos(const Device& before, const Device& after, Changes& changes);

/// Whether the object holds the communication or mapping parameter of a PDO (1400h..1BFFh).
[[nodiscard]] bool is_pdo_parameter(std::uint16_t index);

}  // namespace edsc
