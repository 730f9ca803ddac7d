#include "decode/node_model.hpp"

#include <algorithm>
#include <array>

#include "device/cob_id_parameter.hpp"
#include "device/index_range.hpp"
#include "text/counted.hpp"
#include "values/little_endian.hpp"

namespace edsc {
namespace {

using canopen::CobId;

constexpr std::uint32_t save_signature = 0x6576'6173, load_signature = 0x6461'6F6C;  ///< "save", "load"

constexpr std::uint32_t key_of(std::uint16_t index, std::uint8_t sub_index) {
  return std::uint32_t{index} << 8 | sub_index;
}

/// Whether a value changes the meaning of frames.
bool counts(std::uint16_t index, std::uint8_t sub_index) {
  return canopen::find_cob_id_entries(index, sub_index).has_value() || contains(mapping_parameters, index);
}

/// Parameters that change when frames are sent: SYNC, EMCY, heartbeat and NMT start-up, communication of PDOs.
constexpr std::array timing_parameters = {IndexRange{0x1005, 0x1007}, IndexRange{0x1014, 0x1017},
                                          IndexRange{0x1019, 0x1019}, IndexRange{0x1400, 0x15FF},
                                          IndexRange{0x1800, 0x19FF}, IndexRange{0x1F80, 0x1F80}};

template <class PdoKind>
std::uint16_t communication_of(const PdoKind& pdo) {
  return parameters_of(pdo.direction, pdo.number).communication;
}

}  // namespace

std::string display_name(const Object& object, const Entry& entry) {
  const auto has_denotation = [](const auto& named) {
    return !named.denotation.empty() && named.replaced_name.empty();
  };
  if (has_denotation(entry)) return entry.denotation;
  const std::string& object_name = has_denotation(object) ? object.denotation : object.name;
  return object.has_sub_indices() ? object_name + ", " + entry.name : object_name;
}

NodeModel::NodeModel(std::uint8_t node_id, const Device& device, std::uint32_t inhibit_time_unit)
    : node_id_{node_id}, device_{&device}, inhibit_time_unit_{inhibit_time_unit} {
  find_selectors();
  lay_out_all();
}

std::optional<std::uint32_t> NodeModel::parameter(std::uint16_t index, std::uint8_t sub_index) const {
  if (const auto at = written_.find(key_of(index, sub_index)); at != written_.end()) return at->second;
  const Entry* entry = device_->find(index, sub_index);
  if (entry == nullptr || !entry->default_value) return std::nullopt;
  const Value& value = *entry->default_value;
  return static_cast<std::uint32_t>(value.bits) + (value.plus_node_id ? node_id_ : 0U);
}

/// Without a value, PDOs have the COB-ID of the pre-defined connection set.
CobId NodeModel::cob_id(std::uint16_t index, std::uint8_t sub_index) const {
  const CobIdParameter& row = *find_cob_id_parameter(index, sub_index);
  const bool of_pdo = row.service == CobIdService::rpdo || row.service == CobIdService::tpdo;
  const auto value = parameter(index, sub_index);
  if (!value && !of_pdo) return CobId{CobId::invalid_bit};
  const std::uint32_t base = row.predefined_of(index), own = row.plus_node_id ? node_id_ : 0U;
  const CobId cob_id{value.value_or(base + own)};
  // Bits 31 and 30 of 1005h and 1012h select producer and consumer.
  if (!row.has_valid_bit) return CobId{cob_id.value() & (CobId::extended_bit | 0x1FFF'FFFF)};
  // An EDS with only the base means the formula.
  const bool base_alone = !cob_id.extended() && cob_id.can_id() == base;
  return CobId{cob_id.value() + (base_alone ? own : 0U)};
}

std::vector<SdoServerIds> NodeModel::further_sdo_servers() const {
  std::vector<SdoServerIds> servers;
  constexpr std::uint16_t first = 0x1201, last = 0x127F;
  for (const Object& object : device_->objects) {
    if (object.index < first || object.index > last) continue;
    const SdoServerIds ids{cob_id(object.index, 1), cob_id(object.index, 2)};
    if (ids.request.valid() && ids.response.valid()) servers.push_back(ids);
  }
  return servers;
}

void NodeModel::find_selectors() {
  constexpr std::size_t max_selectors = 256;
  for (const Object& object : device_->objects) {
    for (const Entry& entry : object.entries) {
      if (!entry.meaning || !entry.meaning->depends_on) continue;
      const auto [index, sub_index] = *entry.meaning->depends_on;
      const Entry* const other = device_->find(index, sub_index);
      const bool is_integer = other != nullptr && (other->type->kind == canopen::DataClass::signed_integer ||
                                                   other->type->kind == canopen::DataClass::unsigned_integer);
      if (!is_integer || selector_place(index, sub_index) || selectors_.size() >= max_selectors) continue;
      selectors_.push_back({other, std::nullopt});
    }
  }
}

SelectorPlace NodeModel::selector_place(std::uint16_t index, std::uint8_t sub_index) const {
  const auto found = std::ranges::find_if(
      selectors_, [&](const Selector& one) { return one.entry->index == index && one.entry->sub_index == sub_index; });
  if (found == selectors_.end()) return std::nullopt;
  return static_cast<std::uint8_t>(found - selectors_.begin());
}

std::optional<std::int64_t> NodeModel::selector_of(const Entry& entry) const {
  if (!entry.meaning || !entry.meaning->depends_on) return std::nullopt;
  return selector(selector_place(entry.meaning->depends_on->first, entry.meaning->depends_on->second));
}

void NodeModel::select(std::uint8_t place, std::uint64_t number) {
  Selector& one = selectors_[place];
  const bool is_signed = one.entry->type->kind == canopen::DataClass::signed_integer;
  one.value = is_signed ? sign_extended(number, one.entry->type->bits) : static_cast<std::int64_t>(number);
}

PdoField NodeModel::field(const PlacedObject& mapped) const {
  PdoField field{mapped};
  const Object* object = device_->find(field.index);
  field.entry = object != nullptr ? object->find(field.sub_index) : nullptr;
  if (field.entry != nullptr) {
    field.type = field.entry->type;
    field.name = display_name(*object, *field.entry);
    field.is_formatted = field.type->bits == field.bits && field.type->kind != canopen::DataClass::string &&
                         field.type->kind != canopen::DataClass::domain;
    if (field.is_formatted) {
      field.format = ValueFormat{*device_, *field.entry};
      field.selects = selector_place(field.index, field.sub_index);
      const Meaning* const meaning = field.format.meaning();
      if (meaning != nullptr && meaning->depends_on) {
        field.depends_on = selector_place(meaning->depends_on->first, meaning->depends_on->second);
      }
    }
  } else if (const auto* dummy = canopen::find_data_type(field.index); dummy != nullptr && field.sub_index == 0) {
    field.type = dummy;
    field.name = "(dummy)";
  } else {
    field.name = entry_label(field.index, field.sub_index);
  }
  return field;
}

std::string NodeModel::mapped_name(std::uint32_t mapping) const {
  const PdoField mapped = field({MappingValue::of(mapping)});
  return mapped.name + ", " + counted(unsigned{mapped.bits}, "bit");
}

void NodeModel::lay_out(std::size_t at) {
  const Pdo& pdo = device_->pdos[at];
  PdoLayout layout;
  layout.direction = pdo.direction;
  layout.number = pdo.number;
  constexpr std::uint8_t cob_id_parameter = 1;
  layout.cob_id = cob_id(communication_of(pdo), cob_id_parameter);
  const std::uint16_t index = mapping_parameter_of(communication_of(pdo));
  const std::uint32_t count = parameter(index, 0).value_or(0);
  layout.multiplexed = is_multiplexed(count);
  const auto value_of = [&](std::uint8_t sub_index) { return parameter(index, sub_index).value_or(0); };
  const auto used = layout.multiplexed ? 0U : std::min<std::uint32_t>(count, classical_can.objects);
  for (const PlacedObject& mapped : read_mapping(static_cast<std::uint8_t>(used), value_of)) {
    if (!mapped.is_within(classical_can)) break;
    if (mapped.bits != 0) layout.fields.push_back(field(mapped));
  }
  layout.bits = total_bits(layout.fields);
  layout.has_selectors =
      std::ranges::any_of(layout.fields, [](const PdoField& field) { return field.selects.has_value(); });
  pdos_[at] = std::move(layout);
}

void NodeModel::lay_out_all() {
  pdos_.resize(device_->pdos.size());
  for (std::size_t at = 0; at < pdos_.size(); ++at) lay_out(at);
}

bool NodeModel::learn(std::uint16_t index, std::uint8_t sub_index, std::span<const std::uint8_t> value, bool written) {
  constexpr std::size_t max_bytes = 4;
  if (value.empty()) return false;
  const SelectorPlace selects = selector_place(index, sub_index);
  if (selects && value.size() == bytes_for(selectors_[*selects].entry->type->bits)) select(*selects, number_of(value));
  if (value.size() > max_bytes) return false;
  const auto number = static_cast<std::uint32_t>(number_of(value));
  constexpr std::uint16_t store = 0x1010, restore = 0x1011;
  constexpr std::uint8_t communication = 2;  // 1: all parameters
  const bool of_communication = sub_index == 1 || sub_index == communication;
  if (written && index == store && of_communication && number == save_signature) stored_ = written_;
  if (written && index == restore && of_communication && number == load_signature) stored_.clear();
  const bool changes_meaning = counts(index, sub_index);
  if (!changes_meaning && !contains(timing_parameters, index)) return false;
  if (device_->find(index) == nullptr || parameter(index, sub_index) == number) return false;
  written_[key_of(index, sub_index)] = number;
  if (!changes_meaning) return false;
  for (std::size_t at = 0; at < pdos_.size(); ++at) {
    const std::uint16_t first = communication_of(pdos_[at]);
    if (index == first || index == mapping_parameter_of(first)) lay_out(at);
  }
  return true;
}

bool NodeModel::reset() {
  for (Selector& one : selectors_) one.value.reset();
  if (written_ == stored_) return false;
  written_ = stored_;
  lay_out_all();
  return true;
}

}  // namespace edsc
