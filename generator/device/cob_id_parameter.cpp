#include "device/cob_id_parameter.hpp"

#include <algorithm>

namespace edsc {
namespace {

using enum CobIdService;
namespace code = canopen::function_code;

constexpr std::uint32_t off = canopen::CobId::invalid_bit;
/// From the COB-ID of a PDO to that of the next one.
constexpr std::uint16_t next_pdo = code::rpdo2 - code::rpdo1;

constexpr CobIdParameter parameters[] = {
    {0x1005, 0x1005, 0, 0, sync, false, code::sync, 0, false, "7.5.2.5"},
    {0x1012, 0x1012, 0, 0, time, false, code::time, 0, false, "7.5.2.15"},
    {0x1014, 0x1014, 0, 0, emcy, true, code::emcy, 0, true, "7.5.2.17"},
    {0x1028, 0x1028, 1, 127, emcy_consumer, true, off, 0, false, "7.5.2.31"},
    {0x1200, 0x1200, 1, 1, sdo_server, true, code::sdo_request, 0, true, "7.5.2.33"},
    {0x1200, 0x1200, 2, 2, sdo_server, true, code::sdo_response, 0, true, "7.5.2.33"},
    {0x1201, 0x127F, 1, 2, sdo_server, true, off, 0, false, "7.5.2.33"},
    {0x1280, 0x12FF, 1, 2, sdo_client, true, off, 0, false, "7.5.2.34"},
    {0x1400, 0x1403, 1, 1, rpdo, true, code::rpdo1, next_pdo, true, "7.5.2.35"},
    {0x1404, 0x15FF, 1, 1, rpdo, true, off, 0, false, "7.5.2.35"},
    {0x1800, 0x1803, 1, 1, tpdo, true, code::tpdo1, next_pdo, true, "7.5.2.37"},
    {0x1804, 0x19FF, 1, 1, tpdo, true, off, 0, false, "7.5.2.37"},
};

}  // namespace

std::span<const CobIdParameter> cob_id_parameters() { return parameters; }

const CobIdParameter* find_cob_id_parameter(std::uint16_t index, std::uint8_t sub_index) {
  const auto at = std::ranges::find_if(parameters, [&](const CobIdParameter& row) {
    return index >= row.first && index <= row.last && sub_index >= row.first_sub_index &&
           sub_index <= row.last_sub_index;
  });
  return at != std::end(parameters) ? &*at : nullptr;
}

Value predefined_cob_id(const CobIdParameter& parameter, std::uint16_t index, std::optional<std::uint8_t> node_id,
                        const Position& position) {
  return {.bits = parameter.predefined_of(index) + (parameter.plus_node_id ? node_id.value_or(0) : 0),
          .plus_node_id = parameter.plus_node_id && !node_id,
          .hexadecimal = true,
          .position = position,
          .clause = parameter.clause};
}

}  // namespace edsc
