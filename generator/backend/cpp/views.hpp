/// The parts of the view for the C++ templates, one file for each.
#pragma once

#include <nlohmann/json.hpp>

#include "backend/cpp/cpp_names.hpp"
#include "backend/cpp/memory_layout.hpp"
#include "backend/cpp/typed_values.hpp"
#include "device/device.hpp"
#include "device/options/options.hpp"

namespace edsc {

/// One row for each object: a VAR, an ARRAY of equal elements as a template, or a namespace of entries.
[[nodiscard]] nlohmann::ordered_json object_types_view(const NamedDevice& named, const TypedValues& typed,
                                                       const Options& options);

/// The arguments of the list of these types, with the punctuation behind each.
[[nodiscard]] nlohmann::ordered_json object_rows_view(const NamedDevice& named);

/// The structs and tables of dictionary.hpp.
[[nodiscard]] nlohmann::ordered_json layout_view(const MemoryLayout& layout);

/// One row for each PDO that has a mapping parameter: its layout as a type, and the checks of the C++ compiler.
[[nodiscard]] nlohmann::ordered_json pdo_rows(const NamedDevice& named);

/// Whether the COB-ID of the PDO is invalid, so that it must not be sent.
[[nodiscard]] bool has_wrong_cob_id(const Pdo& pdo);

/// Whether the PDO is not generated, since its mapping or its COB-ID is invalid.
[[nodiscard]] bool is_left_out(const Pdo& pdo);

/// The PDOs that the runtime serves: those with both parameters, and with mapped objects or a dynamic mapping.
[[nodiscard]] nlohmann::ordered_json served_pdos(const Device& device, PdoDirection direction);

/// The rows of pdo_rows() for the check for distinct COB-IDs.
[[nodiscard]] nlohmann::ordered_json distinct_pdos(const Device& device);

/// One row for each COB-ID of SYNC, TIME, EMCY, SDO servers and SDO clients that is enabled after a reset, for the
/// checks of the C++ compiler. PDOs have pdo_rows().
[[nodiscard]] nlohmann::ordered_json cob_id_rows(const Device& device);

struct OptionsView {
  nlohmann::ordered_json runtime;           ///< members of canopen::DeviceOptions and their values
  nlohmann::ordered_json event_conditions;  ///< for entries that trigger an event
  nlohmann::ordered_json emergency_info;    ///< bytes by emergency error code
  nlohmann::ordered_json lss;               ///< members of canopen::LssOptions; null for a device without LSS
  nlohmann::ordered_json storing;           ///< conditions for entries, and how 1010h stores them
};

[[nodiscard]] OptionsView options_view(const Device& device, const Options& options);

}  // namespace edsc
