#include "backend/cpp/views.hpp"

#include <fmt/format.h>

#include <canopen/can/cob_id_check.hpp>
#include <string>
#include <vector>

#include "device/cob_id_parameter.hpp"

namespace edsc {
namespace {

/// A value of canopen::StartCobId; empty if the COB-ID is disabled.
std::string start_cob_id(const CobIdParameter& parameter, const Entry& entry) {
  const auto bits = static_cast<std::uint32_t>(entry.default_value ? entry.default_value->bits : 0);
  const bool plus_node_id = entry.default_value && entry.default_value->plus_node_id;
  if (parameter.has_valid_bit && !canopen::CobId{bits}.valid()) return "";
  // An invalid one is an error. With --keep-going the device has it, but no service uses it.
  if (!canopen::is_legal({entry.index, entry.sub_index, bits, plus_node_id})) return "";
  return fmt::format("canopen::StartCobId{{0x{:04X}, 0x{:02X}, 0x{:X}{}}}", entry.index, entry.sub_index, bits,
                     plus_node_id ? ", true" : "");
}

}  // namespace

nlohmann::ordered_json cob_id_rows(const Device& device) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  constexpr std::uint16_t first_pdo = 0x1400;
  for (const Object& object : device.objects) {
    if (object.index >= first_pdo) break;
    for (const Entry& entry : object.entries) {
      const CobIdParameter* const parameter = find_cob_id_parameter(entry.index, entry.sub_index);
      if (parameter == nullptr) continue;
      const std::string text = start_cob_id(*parameter, entry);
      if (!text.empty()) rows.push_back({{"text", text}, {"separator", rows.empty() ? "" : ","}});
    }
  }
  return rows;
}

}  // namespace edsc
