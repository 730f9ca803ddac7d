#include "edit/read_changes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <canopen/can/cob_id.hpp>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "change/new_objects.hpp"
#include "change/sheet_text.hpp"
#include "device/cob_id_parameter.hpp"
#include "device/types/type_name.hpp"
#include "edit/sheet_parts.hpp"
#include "eds/number.hpp"
#include "text/ascii.hpp"

namespace edsc::edit {
namespace {

using RequestJson = nlohmann::json;

/// Ends the reading of a request.
struct ImpossibleRequest {
  std::string problem;
};

[[noreturn]] void refuse(std::string problem) { throw ImpossibleRequest{std::move(problem)}; }

std::string text_member(const RequestJson& request, const char* name) {
  const auto found = request.find(name);
  if (found == request.end() || !found->is_string()) refuse(fmt::format("missing text \"{}\"", name));
  return found->get<std::string>();
}

std::optional<std::string> optional_text(const RequestJson& request, const char* name) {
  return request.contains(name) ? std::optional{text_member(request, name)} : std::nullopt;
}

std::vector<std::string> text_list(const RequestJson& request, const char* name) {
  const auto found = request.find(name);
  std::vector<std::string> texts;
  if (found == request.end() || !found->is_array()) refuse(fmt::format("missing list \"{}\"", name));
  for (const RequestJson& one : *found) {
    if (!one.is_string()) refuse(fmt::format("\"{}\" is a list of texts", name));
    texts.push_back(one.get<std::string>());
  }
  return texts;
}

/// `100`, `0x64`, `64h`.
std::optional<std::uint64_t> number_in(std::string_view text) {
  text = trim(text);
  const auto number = parse_unsigned(text);
  return number ? number : parse_h_suffix(text);
}

template <class Number>
Number number_up_to(const std::string& text, std::string_view what, std::uint64_t most) {
  const auto number = number_in(text);
  if (!number || *number > most) refuse(fmt::format("{}: expected a number from 0 to {}", what, most));
  return static_cast<Number>(*number);
}

std::uint16_t index_in(std::string_view text) {
  text = trim(text);
  if (text.starts_with("0x") || text.starts_with("0X")) text.remove_prefix(2);
  if (text.ends_with('h') || text.ends_with('H')) text.remove_suffix(1);
  const auto index = parse_hex(text, 4);
  if (!index) refuse(fmt::format("{} is not an index: expected four hexadecimal digits, such as 2000h", text));
  return *index;
}

/// A time in milliseconds in units of a PDO parameter.
std::uint16_t units_of(const std::string& text, std::string_view what, std::uint32_t unit_us) {
  const auto number = parse_real(trim(text));
  const double units = number ? *number * 1000 / unit_us : -1;
  constexpr double tolerance = 1e-6;
  if (units < 0 || units > UINT16_MAX || std::abs(units - std::round(units)) > tolerance) {
    refuse(fmt::format("{}: expected a multiple of {} ms, {} ms at most", what, unit_us / 1000.0,
                       UINT16_MAX * (unit_us / 1000.0)));
  }
  return static_cast<std::uint16_t>(std::lround(units));
}

class RequestReader {
 public:
  RequestReader(const OpenSheet& sheet, const SourceFile* imported) : sheet_{sheet}, imported_{imported} {}

  std::vector<SheetChange> read(const RequestJson& request) {
    const auto kind = request.is_object() ? request.find("do") : request.end();
    if (request.is_object() && kind != request.end() && kind->is_string()) {
      if (*kind == "pdo") return {pdo(request)};
      if (*kind == "new") return {AddSections{new_sections(request)}};
    }
    std::string problem;
    auto change = read_change(request, problem);
    if (!change) refuse(std::move(problem));
    if (auto* const set = std::get_if<SetValue>(&*change)) return value(std::move(*set));
    return {*std::move(change)};
  }

 private:
  std::vector<SheetChange> value(SetValue set) {
    set.value = std::string{trim(set.value)};
    if (set.value.empty()) {
      const SheetText text{*sheet_.source};
      const TextSection* const section = text.find(set.section);
      if (section == nullptr || !text.find_entry(*section, set.key)) return {};
      return {RemovePart{std::move(set.section), std::move(set.key)}};
    }
    if (equal_ignoring_case(set.key, "DataType")) {
      if (const canopen::DataTypeRow* const type = find_type_by_name(set.value)) {
        set.value = fmt::format("0x{:04X}", static_cast<unsigned>(type->type));
      }
    }
    return {std::move(set)};
  }

  SheetChange pdo(const RequestJson& request) {
    MapPdo change;
    const std::string direction = text_member(request, "direction");
    if (direction != "rpdo" && direction != "tpdo") refuse("\"direction\" is rpdo or tpdo");
    change.direction = direction == "rpdo" ? PdoDirection::receive : PdoDirection::transmit;
    const RequestJson number = request.value("number", RequestJson{});
    if (!number.is_number_unsigned() || number.get<std::uint64_t>() - 1 >= classical_can.pdos) {
      refuse(fmt::format("\"number\" is 1 to {}", classical_can.pdos));
    }
    change.number = number.get<std::uint16_t>();
    if (request.contains("entries")) {
      change.objects.emplace();
      for (const std::string& raw : text_list(request, "entries")) {
        change.objects->push_back(MappingValue::of(number_up_to<std::uint32_t>(raw, "entry", UINT32_MAX)));
      }
    }
    if (request.contains("cob_id")) change.cob_id = cob_id(request["cob_id"], change);
    if (const auto text = optional_text(request, "type")) {
      change.transmission_type = number_up_to<std::uint8_t>(*text, "transmission type", 255);
    }
    if (const auto text = optional_text(request, "event_ms")) {
      change.event_timer = units_of(*text, "event timer", 1000);
    }
    if (const auto text = optional_text(request, "inhibit_ms")) {
      change.inhibit_time = units_of(*text, "inhibit time", sheet_.options.inhibit_time_unit());
    }
    if (const auto text = optional_text(request, "sync_start")) {
      change.sync_start = number_up_to<std::uint8_t>(*text, "SYNC start value", 240);
    }
    return change;
  }

  /// The COB-ID of a choice. Bit 30, by which a TPDO does not answer RTR, remains.
  std::string cob_id(const RequestJson& choice, const MapPdo& change) const {
    const std::uint16_t index = parameters_of(change.direction, change.number).communication;
    const CobIdParameter* const row = find_cob_id_parameter(index, 1);
    const Entry* const entry = sheet_.device ? sheet_.device->find(index, 1) : nullptr;
    const Value old = entry != nullptr && entry->default_value ? *entry->default_value : Value{};
    constexpr std::uint32_t not_valid = 0x8000'0000;
    constexpr std::uint32_t no_rtr = 0x4000'0000;
    const std::uint32_t kept = static_cast<std::uint32_t>(old.bits) & no_rtr;
    const std::string kind = choice.is_object() ? text_member(choice, "kind") : "";
    const auto text = [](std::uint32_t value, bool plus_node_id) {
      return fmt::format("{}0x{:X}", plus_node_id ? "$NODEID+" : "", value);
    };
    if (kind == "disabled") return text(static_cast<std::uint32_t>(old.bits) | not_valid, old.plus_node_id);
    if (kind == "predefined") {
      if (row == nullptr || !row->plus_node_id) {
        refuse(fmt::format("CiA 301 does not have a predefined CAN-ID of {} {}",
                           change.direction == PdoDirection::receive ? "RPDO" : "TPDO", change.number));
      }
      return text(row->predefined_of(index) | kept, true);
    }
    if (kind != "node" && kind != "fixed") refuse("the kind of a COB-ID is predefined, node, fixed or disabled");
    const auto can_id =
        number_up_to<std::uint32_t>(text_member(choice, "value"), "CAN-ID", canopen::CobId{0x7FF}.can_id());
    return text(can_id | kept, kind == "node");
  }

  std::vector<NewSection> new_sections(const RequestJson& request) const {
    const std::string kind = text_member(request, "kind");
    if (kind == "standard") return standard(request);
    if (kind == "copy") return copies(request);
    if (kind == "import") return imports(request);
    return sections_of(described(request, kind), sheet_.source->choices().sub_indices);
  }

  std::vector<NewSection> standard(const RequestJson& request) const {
    std::vector<NewSection> sections;
    for (const std::string& word : text_list(request, "objects")) {
      const auto object = standard_object(index_in(word), profile_of(sheet_), 1);
      if (!object) refuse(fmt::format("edsc does not know the data type of {}", word));
      std::ranges::move(sections_of(*object, sheet_.source->choices().sub_indices), std::back_inserter(sections));
    }
    return sections;
  }

  std::vector<NewSection> copies(const RequestJson& request) const {
    const std::string from = text_member(request, "from");
    const SheetText text{*sheet_.source};
    std::vector<NewSection> sections;
    for (const std::string& to : text_list(request, "to")) {
      append(copied_sections(text, index_in(from), index_in(to)), from, sections);
    }
    return sections;
  }

  std::vector<NewSection> imports(const RequestJson& request) const {
    if (imported_ == nullptr) refuse("choose a file to import from first");
    const SheetText text{*imported_};
    std::vector<NewSection> sections;
    for (const std::string& word : text_list(request, "objects")) {
      append(copied_sections(text, index_in(word), index_in(word)), word, sections);
    }
    return sections;
  }

  static void append(std::vector<NewSection> copy, const std::string& from, std::vector<NewSection>& sections) {
    if (copy.empty()) refuse(fmt::format("{} does not exist", from));
    std::ranges::move(copy, std::back_inserter(sections));
  }

  static NewObject described(const RequestJson& request, const std::string& kind) {
    NewObject object{index_in(text_member(request, "index")), ObjectType::var, text_member(request, "name"), {}};
    NewValue value{object.name, find_type_by_name(text_member(request, "type")), text_member(request, "access")};
    if (value.type == nullptr) refuse(fmt::format("{} is not a data type", text_member(request, "type")));
    const auto* const row = std::ranges::find(canopen::access_rows, value.access, &canopen::AccessRow::name);
    if (row == std::end(canopen::access_rows)) refuse(fmt::format("{} is not an access type", value.access));
    const RequestJson mappable = request.value("mappable", RequestJson(false));
    value.mappable = mappable.is_boolean() && mappable.get<bool>();
    if (value.type->bits != 0) value.default_value = "0";
    if (kind == "VAR") {
      object.values.push_back(std::move(value));
      return object;
    }
    if (kind != "ARRAY" && kind != "RECORD") refuse("the kind of an object is VAR, ARRAY or RECORD");
    const RequestJson elements = request.value("elements", RequestJson{});
    if (!elements.is_number_unsigned() || elements.get<std::uint64_t>() - 1 >= 254) {
      refuse("an ARRAY or RECORD has 1 to 254 elements");
    }
    object.type = kind == "ARRAY" ? ObjectType::array : ObjectType::record;
    for (unsigned i = 1; i <= elements.get<unsigned>(); ++i) {
      object.values.push_back(value);
      object.values.back().name = fmt::format("{} {}", object.name, i);
    }
    return object;
  }

  const OpenSheet& sheet_;
  const SourceFile* imported_;
};

}  // namespace

RequestedChanges read_requests(const nlohmann::json& list, const OpenSheet& sheet, const SourceFile* imported) {
  RequestedChanges read;
  RequestReader reader{sheet, imported};
  for (std::size_t i = 0; i < list.size(); ++i) {
    try {
      for (SheetChange& change : reader.read(list[i])) {
        read.changes.push_back(std::move(change));
        read.requests.push_back(i);
      }
    } catch (const ImpossibleRequest& impossible) {
      read.problem = impossible.problem;
      read.problem_at = i;
      return read;
    }
  }
  return read;
}

}  // namespace edsc::edit
