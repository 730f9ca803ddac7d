/// Access and mapping attributes of an object (CiA 301, 7.4.5; CiA 306-1, 4.6.2).
#pragma once

#include <cstdint>
#include <string_view>

namespace canopen {

/// Access as seen from the bus.
enum class Access : std::uint8_t {
  ro,
  wo,
  rw,
  rwr,  ///< read and write, process input: TPDO-mappable
  rww,  ///< read and write, process output: RPDO-mappable
  constant,
};

struct AccessRow {
  Access access;
  bool readable;          ///< by SDO
  bool writable;          ///< by SDO
  bool in_tpdo;           ///< may be mapped into a TPDO
  bool in_rpdo;           ///< may be mapped into an RPDO
  std::string_view name;  ///< as an EDS spells it
};

// clang-format off
inline constexpr AccessRow access_rows[] = {
    {Access::ro, true, false, true, false, "ro"},
    {Access::wo, false, true, false, true, "wo"},
    {Access::rw, true, true, true, true, "rw"},
    {Access::rwr, true, true, true, false, "rwr"},
    {Access::rww, true, true, false, true, "rww"},
    {Access::constant, true, false, true, false, "const"},
};
// clang-format on

[[nodiscard]] constexpr const AccessRow& row_of(Access access) {
  return access_rows[static_cast<std::uint8_t>(access)];
}
[[nodiscard]] constexpr bool readable(Access access) { return row_of(access).readable; }
[[nodiscard]] constexpr bool writable(Access access) { return row_of(access).writable; }

/// PDO directions that an object may be mapped into.
enum class Mappable : std::uint8_t { no = 0, tpdo = 1, rpdo = 2, both = 3 };

[[nodiscard]] constexpr bool allows(Mappable mappable, Mappable direction) {
  return (static_cast<std::uint8_t>(mappable) & static_cast<std::uint8_t>(direction)) != 0;
}

/// Returns the mapping attribute of an entry with PDOMapping=1 and this access type.
[[nodiscard]] constexpr Mappable mappable_by(Access access) {
  const AccessRow& row = row_of(access);
  return static_cast<Mappable>((row.in_tpdo ? 1 : 0) | (row.in_rpdo ? 2 : 0));
}

}  // namespace canopen
