#include "backend/cpp/cpp_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "backend/cpp/cpp_text.hpp"
#include "backend/cpp/json_object.hpp"
#include "backend/cpp/profile_types.hpp"
#include "backend/cpp/views.hpp"
#include "device/stored_eds.hpp"
#include "system/path.hpp"
#include "text/ascii.hpp"
#include "text/source_file.hpp"

namespace edsc {
namespace {

using nlohmann::ordered_json;

/// The bytes of the EDS as lines of C++ if the device stores it; otherwise null.
ordered_json stored_eds_view(const Device& device, const Options& options) {
  constexpr std::size_t bytes_in_a_line = 24;
  const std::string bytes = stored_eds(device, options);
  if (bytes.empty()) return nullptr;
  ordered_json lines = json_array(bytes.size() / bytes_in_a_line + 1);
  std::string line;
  for (const char byte : bytes) {
    if (line.size() >= bytes_in_a_line * 5) lines.push_back(std::exchange(line, {}));
    line += fmt::format("0x{:02X},", static_cast<unsigned char>(byte));
  }
  lines.push_back(std::move(line));
  const bool compressed = options.stored_eds == StoredEds::compressed;
  return json_object("lines", std::move(lines), "what", compressed ? "as a gzip file" : "as text in UTF-8");
}

/// The enumerator of canopen::DataType: its name in lower case.
std::string type_enumerator(const canopen::DataTypeRow& type) {
  std::string out{type.name};
  std::ranges::transform(out, out.begin(), to_lower);
  return out;
}

std::string upper_case(std::string text) {
  std::ranges::transform(text, text.begin(), to_upper);
  return text;
}

/// Bit n is set if an RPDO may map data type n as a dummy.
std::string dummy_mask(const Device& device) {
  std::uint32_t mask = 0;
  for (const std::uint16_t dummy : device.dummies) mask |= dummy < 32 ? std::uint32_t{1} << dummy : 0;
  return fmt::format("0x{:04X}", mask);
}

ordered_json description_rows(const Device& device) {
  ordered_json rows = ordered_json::array();
  for (const Object& object : device.objects) {
    const std::string object_name = cpp_string(object.name);
    for (const Entry& entry : object.entries) {
      rows.push_back(fmt::format("{{0x{:04X}, 0x{:02X}, canopen::DataType::{}, {}, {}}}", entry.index, entry.sub_index,
                                 type_enumerator(*entry.type), object_name,
                                 object.has_sub_indices() ? cpp_string(entry.name) : "{}"));
    }
  }
  return rows;
}

}  // namespace

ordered_json cpp_view(const NamedDevice& named, const Options& options, Diagnostics& diagnostics) {
  const Device& device = named.device;
  const std::string& space = named.names.space();
  const auto table = [](ordered_json rows) {
    const bool any_row = !rows.empty();
    return json_object("any", any_row, "rows", std::move(rows));
  };
  OptionsView view = options_view(device, options);
  const TypedValues typed{named, options};
  std::string closed_objects = typed.closed_objects(named);
  ordered_json profile;
  if (typed.uses_profile_types()) {
    profile = json_object("types", cia402_types.types_file, "text", cia402_types.text_file, "namespace",
                          cia402_types.name_space);
  }
  return json_object(
      "file", cpp_comment(file_name_of(device.source->name())), "namespace", space, "guard",
      upper_case("edsc_" + space), "product_name",
      cpp_string(device.product_name.empty() ? space : device.product_name), "types",
      object_types_view(named, typed, options), "typed_values", typed.any(), "meaning", typed.definitions(),
      "meaning_text", typed.names_of_values(), "meaning_namespace", space + "::meaning", "meaning_header",
      "\"meaning.hpp\"", "profile", std::move(profile), "closed_objects",
      closed_objects.empty() ? ordered_json(nullptr) : ordered_json(std::move(closed_objects)), "object_rows",
      object_rows_view(named), "memory", layout_view(lay_out(named, options, diagnostics)), "zero_terminated_strings",
      options.zero_terminated_strings, "pdos", pdo_rows(named), "distinct_pdos", table(distinct_pdos(device)),
      "cob_ids", table(cob_id_rows(device)), "rpdos", served_pdos(device, PdoDirection::receive), "tpdos",
      served_pdos(device, PdoDirection::transmit), "options", std::move(view.runtime), "any_options",
      !options.runtime.empty(), "event_conditions", std::move(view.event_conditions), "any_event_condition",
      !options.no_event.empty(), "emergency_info", std::move(view.emergency_info), "any_emergency_info",
      !options.emergency_info.empty(), "descriptions", description_rows(device), "node_id",
      device.node_id ? ordered_json(*device.node_id) : ordered_json(nullptr), "dummies", dummy_mask(device),
      "granularity", device.information.capabilities.granularity.value_or(1), "lss", std::move(view.lss), "stored_eds",
      stored_eds_view(device, options), "storing", std::move(view.storing), "any_storing",
      !options.storing.empty() || !options.stored_by.empty());
}

}  // namespace edsc
