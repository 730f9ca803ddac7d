/// A new EDS: identity, objects of CiA 301 and of a device profile, PDOs.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "change/change.hpp"

namespace edsc {

/// A mode of operation of a drive: its name, its bit of 6502h, its value of 6060h, and the objects that it needs.
struct DriveModeRow {
  std::string_view name;
  std::uint8_t bit;
  std::int8_t mode;
  std::vector<std::uint16_t> objects;
};
[[nodiscard]] const std::vector<DriveModeRow>& drive_mode_rows();

struct NewSheet {
  std::string file_name;
  std::string vendor_name, product_name;
  std::uint32_t vendor = 0, product = 0, revision = 0;
  std::uint16_t profile = 0;                  ///< 401, 402, 404, 406, or 0: none
  std::vector<const DriveModeRow*> modes;     ///< of a drive
  std::vector<std::uint16_t> bit_rates;       ///< kbit/s
  std::optional<std::uint16_t> heartbeat_ms;  ///< default value of 1017h
  bool stores = false;                        ///< 1010h and 1011h
  bool has_lss = false;
  /// The objects of each PDO, from PDO 1 on. Empty: those that the profile suggests.
  std::vector<std::vector<std::uint16_t>> tpdos, rpdos;
  std::string date, time;  ///< `11-29-2026`, `12:00AM`
};

/// The text in canonical form. `problem` names an object that edsc does not know.
[[nodiscard]] std::string new_sheet_text(const NewSheet& sheet, std::string& problem);

}  // namespace edsc
