/// The objects of the communication profile, one row each: CiA 301, 7.5.2.
#pragma once

#include <canopen/od/access.hpp>
#include <canopen/od/data_type.hpp>
#include <cstdint>
#include <span>
#include <string_view>

#include "device/device.hpp"

namespace edsc {

/// Access types that an entry may have, one bit each.
class AccessSet {
 public:
  template <typename... Accesses>
  constexpr explicit AccessSet(Accesses... accesses) : bits_{((1U << static_cast<unsigned>(accesses)) | ...)} {}

  [[nodiscard]] constexpr bool has(canopen::Access access) const {
    return (bits_ & (1U << static_cast<unsigned>(access))) != 0;
  }

  /// The access type of an entry whose EDS states none that can be read.
  [[nodiscard]] constexpr canopen::Access assumed() const {
    using canopen::Access;
    return has(Access::rw) ? Access::rw : has(Access::wo) ? Access::wo : Access::ro;
  }

 private:
  unsigned bits_;
};

namespace access_sets {
using canopen::Access;
/// Values that the device reports.
inline constexpr AccessSet read_only{Access::ro, Access::constant};
/// Values that a master sets, unless the device does not support it.
inline constexpr AccessSet settable{Access::rw, Access::rwr, Access::rww, Access::ro, Access::constant};
/// Values that a master must be able to set.
inline constexpr AccessSet read_write{Access::rw, Access::rwr, Access::rww};
inline constexpr AccessSet write_only{Access::wo};
}  // namespace access_sets

/// Sub-indices `first` to `last` of an object; of a VAR both are 0. Sub-index 0 of ARRAYs and RECORDs has separate
/// rules.
struct StandardEntry {
  std::uint8_t first;
  std::uint8_t last;
  canopen::DataType type;
  AccessSet access;
  bool required = false;    ///< `first` is mandatory
  bool may_differ = false;  ///< services work with any integer of at most 32 bits, or do not use it
};

struct StandardObject {
  std::uint16_t first;  ///< PDO parameters and SDO parameters are 512 or 128 objects of one kind
  std::uint16_t last;
  ObjectType type;
  std::string_view name;
  std::string_view clause;
  std::span<const StandardEntry> entries;
};

namespace standard {

using canopen::DataType;
using enum canopen::DataType;
using namespace access_sets;

constexpr StandardEntry value(DataType type, AccessSet access) { return {0, 0, type, access}; }
/// A value that no service of the device uses by its type.
constexpr StandardEntry of_any_type(DataType type, AccessSet access) { return {0, 0, type, access, false, true}; }

inline constexpr StandardEntry read_only_u32[] = {value(unsigned32, read_only)};
inline constexpr StandardEntry status_u32[] = {of_any_type(unsigned32, read_only)};
inline constexpr StandardEntry read_only_u8[] = {value(unsigned8, read_only)};
inline constexpr StandardEntry read_only_text[] = {of_any_type(visible_string, read_only)};
inline constexpr StandardEntry read_only_domain[] = {of_any_type(domain, read_only)};
inline constexpr StandardEntry set_u8[] = {value(unsigned8, settable)};
inline constexpr StandardEntry set_u16[] = {value(unsigned16, settable)};
inline constexpr StandardEntry set_u32[] = {value(unsigned32, settable)};
inline constexpr StandardEntry clock_u32[] = {of_any_type(unsigned32, settable)};
inline constexpr StandardEntry command_mode[] = {of_any_type(unsigned8, write_only)};
inline constexpr StandardEntry error_field[] = {{0x01, 0xFE, unsigned32, read_only, true}};
inline constexpr StandardEntry store[] = {{0x01, 0x7F, unsigned32, settable, true}};
inline constexpr StandardEntry heartbeat_consumer[] = {{0x01, 0x7F, unsigned32, settable, true}};
inline constexpr StandardEntry identity[] = {{0x01, 0x01, unsigned32, read_only, true},
                                             {0x02, 0x04, unsigned32, read_only}};
inline constexpr StandardEntry verify_configuration[] = {{0x01, 0x01, unsigned32, read_write, true},
                                                         {0x02, 0x02, unsigned32, read_write, true}};
inline constexpr StandardEntry module_list[] = {{0x01, 0xFE, unsigned16, read_only, true, true}};
inline constexpr StandardEntry emergency_consumer[] = {{0x01, 0x7F, unsigned32, settable, true}};
inline constexpr StandardEntry error_behavior[] = {{0x01, 0xFE, unsigned8, settable, true, true}};
inline constexpr StandardEntry default_sdo[] = {{0x01, 0x01, unsigned32, read_only, true},
                                                {0x02, 0x02, unsigned32, read_only, true},
                                                {0x03, 0x03, unsigned8, settable}};
inline constexpr StandardEntry sdo[] = {{0x01, 0x01, unsigned32, settable, true},
                                        {0x02, 0x02, unsigned32, settable, true},
                                        {0x03, 0x03, unsigned8, settable}};
inline constexpr StandardEntry pdo_communication[] = {
    {0x01, 0x01, unsigned32, settable, true}, {0x02, 0x02, unsigned8, settable, true},
    {0x03, 0x03, unsigned16, settable},       {0x04, 0x04, unsigned8, settable, false, true},
    {0x05, 0x05, unsigned16, settable},       {0x06, 0x06, unsigned8, settable},
};
inline constexpr StandardEntry pdo_mapping[] = {{0x01, 0x40, unsigned32, settable}};

inline constexpr auto var = ObjectType::var;
inline constexpr auto array = ObjectType::array;
inline constexpr auto record = ObjectType::record;

/// Ascending by index.
inline constexpr StandardObject objects[] = {
    {0x1000, 0x1000, var, "device type", "7.5.2.1", read_only_u32},
    {0x1001, 0x1001, var, "error register", "7.5.2.2", read_only_u8},
    {0x1002, 0x1002, var, "manufacturer status register", "7.5.2.3", status_u32},
    {0x1003, 0x1003, array, "pre-defined error field", "7.5.2.4", error_field},
    {0x1005, 0x1005, var, "COB-ID SYNC message", "7.5.2.5", set_u32},
    {0x1006, 0x1006, var, "communication cycle period", "7.5.2.6", set_u32},
    {0x1007, 0x1007, var, "synchronous window length", "7.5.2.7", set_u32},
    {0x1008, 0x1008, var, "manufacturer device name", "7.5.2.8", read_only_text},
    {0x1009, 0x1009, var, "manufacturer hardware version", "7.5.2.9", read_only_text},
    {0x100A, 0x100A, var, "manufacturer software version", "7.5.2.10", read_only_text},
    {0x100C, 0x100C, var, "guard time", "7.5.2.11", set_u16},
    {0x100D, 0x100D, var, "life time factor", "7.5.2.12", set_u8},
    {0x1010, 0x1010, array, "store parameters", "7.5.2.13", store},
    {0x1011, 0x1011, array, "restore default parameters", "7.5.2.14", store},
    {0x1012, 0x1012, var, "COB-ID time stamp object", "7.5.2.15", set_u32},
    {0x1013, 0x1013, var, "high resolution time stamp", "7.5.2.16", clock_u32},
    {0x1014, 0x1014, var, "COB-ID EMCY", "7.5.2.17", set_u32},
    {0x1015, 0x1015, var, "inhibit time EMCY", "7.5.2.18", set_u16},
    {0x1016, 0x1016, array, "consumer heartbeat time", "7.5.2.19", heartbeat_consumer},
    {0x1017, 0x1017, var, "producer heartbeat time", "7.5.2.20", set_u16},
    {0x1018, 0x1018, record, "identity object", "7.5.2.21", identity},
    {0x1019, 0x1019, var, "synchronous counter overflow value", "7.5.2.22", set_u8},
    {0x1020, 0x1020, array, "verify configuration", "7.5.2.23", verify_configuration},
    {0x1021, 0x1021, var, "store EDS", "7.5.2.24", read_only_domain},
    {0x1024, 0x1024, var, "OS command mode", "7.5.2.27", command_mode},
    {0x1027, 0x1027, array, "module list", "7.5.2.30", module_list},
    {0x1028, 0x1028, array, "emergency consumer object", "7.5.2.31", emergency_consumer},
    {0x1029, 0x1029, array, "error behavior object", "7.5.2.32", error_behavior},
    {0x1200, 0x1200, record, "SDO server parameter", "7.5.2.33", default_sdo},
    {0x1201, 0x127F, record, "SDO server parameter", "7.5.2.33", sdo},
    {0x1280, 0x12FF, record, "SDO client parameter", "7.5.2.34", sdo},
    {0x1400, 0x15FF, record, "RPDO communication parameter", "7.5.2.35", pdo_communication},
    {0x1600, 0x17FF, record, "RPDO mapping parameter", "7.5.2.36", pdo_mapping},
    {0x1800, 0x19FF, record, "TPDO communication parameter", "7.5.2.37", pdo_communication},
    {0x1A00, 0x1BFF, record, "TPDO mapping parameter", "7.5.2.38", pdo_mapping},
};

}  // namespace standard

/// The row of an index; null if CiA 301 does not describe it.
[[nodiscard]] const StandardObject* find_standard_object(std::uint16_t index);
/// The row of a sub-index; null if CiA 301 does not describe it.
[[nodiscard]] const StandardEntry* find_standard_entry(const StandardObject& object, std::uint8_t sub_index);
/// The same for an index; also null for sub-index 0 of an ARRAY or RECORD.
[[nodiscard]] const StandardEntry* find_standard_entry(std::uint16_t index, std::uint8_t sub_index);

/// Objects that each device has.
inline constexpr std::uint16_t required_objects[] = {0x1000, 0x1001, 0x1018};

/// `index` requires `needed`.
struct ObjectNeed {
  std::uint16_t index;
  std::uint16_t needed;
  std::string_view what;  ///< name of `needed`
};

inline constexpr ObjectNeed object_needs[] = {
    {0x1006, 0x1005, "COB-ID SYNC message"}, {0x1007, 0x1005, "COB-ID SYNC message"},
    {0x1019, 0x1005, "COB-ID SYNC message"}, {0x100C, 0x100D, "Life time factor"},
    {0x100D, 0x100C, "Guard time"},          {0x1015, 0x1014, "COB-ID EMCY"},
    {0x1022, 0x1021, "Store EDS"},
};

}  // namespace edsc
