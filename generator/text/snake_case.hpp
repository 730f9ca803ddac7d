/// Identifiers from names for people.
#pragma once

#include <string>
#include <string_view>

namespace edsc {

/// `Position actual value` -> `position_actual_value`, `COB-ID SYNC` -> `cob_id_sync`, `NrOfRxPDO` -> `nr_of_rx_pdo`,
/// `24V supply` -> `n_24v_supply`. Abbreviations and product names are one word, also in mixed case: `CANopenVersion`
/// -> `canopen_version`, `CiA402 mode` -> `cia402_mode`, `Limit (kHz)` -> `limit_khz`. Non-ASCII letters are
/// transliterated if usual (ae for a-umlaut, u for micro) and omitted otherwise. Empty if nothing remains. The words
/// that a language reserves are not considered.
[[nodiscard]] std::string to_snake_case(std::string_view name);

}  // namespace edsc
