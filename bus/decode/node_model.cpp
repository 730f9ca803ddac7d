#include "decode/node_model.hpp"

#include <algorithm>
#include <canopen/pdo/pdo_mapping.hpp>

namespace edsc {
namespace {

using canopen::CobId;

constexpr unsigned max_bits = 64;
constexpr std::uint8_t max_mapped = 64;
constexpr std::uint32_t save_signature = 0x6576'6173, load_signature = 0x6461'6F6C;  ///< "save", "load"

/// Objects that change the meaning of frames.
struct Range {
  std::uint16_t first, last;
  std::uint8_t first_sub_index, last_sub_index;
};

constexpr Range communication_parameters[] = {
    {0x1005, 0x1005, 0, 0}, {0x1012, 0x1012, 0, 0},  {0x1014, 0x1014, 0, 0}, {0x1201, 0x127F, 1, 2},
    {0x1400, 0x15FF, 1, 1}, {0x1600, 0x17FF, 0, 64}, {0x1800, 0x19FF, 1, 1}, {0x1A00, 0x1BFF, 0, 64},
};

bool counts(std::uint16_t index, std::uint8_t sub_index) {
  return std::ranges::any_of(communication_parameters, [&](const Range& row) {
    return index >= row.first && index <= row.last && sub_index >= row.first_sub_index &&
           sub_index <= row.last_sub_index;
  });
}

constexpr std::uint32_t key_of(std::uint16_t index, std::uint8_t sub_index) {
  return std::uint32_t{index} << 8 | sub_index;
}

/// Number 0 for a parameter of another kind.
struct PdoParameter {
  PdoDirection direction = PdoDirection::receive;
  std::uint16_t number = 0;
};

PdoParameter pdo_of(std::uint16_t index) {
  const bool parameter = index >= 0x1400 && index <= 0x1BFF;
  if (!parameter) return {};
  return {index < 0x1800 ? PdoDirection::receive : PdoDirection::transmit,
          static_cast<std::uint16_t>((index & 0x1FF) + 1)};
}

/// CAN-ID of one of the first four PDOs in the pre-defined connection set, without node-ID.
std::uint32_t predefined_id(PdoDirection direction, std::uint16_t number) {
  const std::uint32_t first =
      direction == PdoDirection::receive ? canopen::function_code::rpdo1 : canopen::function_code::tpdo1;
  return first + 0x100U * (number - 1U);
}

}  // namespace

std::string display_name(const Object& object, const Entry& entry) {
  if (!entry.denotation.empty()) return entry.denotation;
  const std::string& object_name = object.denotation.empty() ? object.name : object.denotation;
  return object.has_sub_indices() ? object_name + ", " + entry.name : object_name;
}

NodeModel::NodeModel(std::uint8_t node_id, const Device& device) : node_id_{node_id}, device_{&device} {
  profile_ = static_cast<std::uint16_t>(parameter(0x1000, 0).value_or(0));
  lay_out_all();
}

std::optional<std::uint32_t> NodeModel::parameter(std::uint16_t index, std::uint8_t sub_index) const {
  if (const auto at = written_.find(key_of(index, sub_index)); at != written_.end()) return at->second;
  const Entry* entry = device_->find(index, sub_index);
  if (entry == nullptr || !entry->default_value) return std::nullopt;
  const Value& value = *entry->default_value;
  return static_cast<std::uint32_t>(value.bits) + (value.plus_node_id ? node_id_ : 0U);
}

std::optional<CobId> NodeModel::cob_id(std::uint16_t index) const {
  const auto value = parameter(index, 0);
  if (!value) return std::nullopt;
  constexpr std::uint32_t identifier = CobId::extended_bit | 0x1FFF'FFFF;
  // Bits 31 and 30 of 1005h and 1012h select producer and consumer; bit 31 of 1014h means that EMCY does not exist.
  if (index != 0x1014) return CobId{*value & identifier};
  const bool base_alone = !CobId{*value}.extended() && CobId{*value}.can_id() == canopen::function_code::emcy;
  return CobId{*value + (base_alone ? node_id_ : 0U)};
}

CobId NodeModel::pdo_cob_id(const Pdo& pdo) const {
  constexpr std::uint8_t cob_id = 1;
  constexpr std::uint16_t predefined_pdos = 4;
  const bool receive = pdo.direction == PdoDirection::receive;
  const auto index = static_cast<std::uint16_t>((receive ? 0x1400 : 0x1800) + pdo.number - 1);
  const auto value = parameter(index, cob_id);
  if (pdo.number > predefined_pdos) return value ? CobId{*value} : CobId{};
  const std::uint32_t predefined = predefined_id(pdo.direction, pdo.number);
  if (!value) return CobId{predefined + node_id_};
  // An EDS with only the base means the formula.
  const bool base_alone = !CobId{*value}.extended() && CobId{*value}.can_id() == predefined;
  return CobId{*value + (base_alone ? node_id_ : 0U)};
}

std::vector<SdoServerIds> NodeModel::further_sdo_servers() const {
  std::vector<SdoServerIds> servers;
  constexpr std::uint16_t first = 0x1201, last = 0x127F;
  for (const Object& object : device_->objects) {
    if (object.index < first || object.index > last) continue;
    const SdoServerIds ids{CobId{parameter(object.index, 1).value_or(CobId::invalid_bit)},
                           CobId{parameter(object.index, 2).value_or(CobId::invalid_bit)}};
    if (ids.request.valid() && ids.response.valid()) servers.push_back(ids);
  }
  return servers;
}

PdoField NodeModel::field(std::uint32_t mapping) const {
  PdoField field;
  field.index = static_cast<std::uint16_t>(mapping >> 16);
  field.sub_index = static_cast<std::uint8_t>(mapping >> 8);
  field.bits = static_cast<std::uint8_t>(mapping);
  const Object* object = device_->find(field.index);
  field.entry = object != nullptr ? object->find(field.sub_index) : nullptr;
  if (field.entry != nullptr) {
    field.type = field.entry->type;
    field.name = display_name(*object, *field.entry);
    if (profile_ == 402 && field.bits == 16) field.drive_word = drive_word_at(field.index, field.sub_index);
  } else if (const auto* dummy = canopen::find_data_type(field.index); dummy != nullptr && field.sub_index == 0) {
    field.dummy = true;
    field.type = dummy;
    field.name = "(dummy)";
  } else {
    field.name = entry_label(field.index, field.sub_index);
  }
  return field;
}

std::string NodeModel::mapped_name(std::uint32_t mapping) const {
  const PdoField mapped = field(mapping);
  return mapped.name + ", " + std::to_string(mapped.bits) + (mapped.bits == 1 ? " bit" : " bits");
}

void NodeModel::lay_out(std::size_t at) {
  const Pdo& pdo = device_->pdos[at];
  PdoLayout layout;
  layout.direction = pdo.direction;
  layout.number = pdo.number;
  layout.cob_id = pdo_cob_id(pdo);
  const bool receive = pdo.direction == PdoDirection::receive;
  const auto index = static_cast<std::uint16_t>((receive ? 0x1600 : 0x1A00) + pdo.number - 1);
  const std::uint32_t count = parameter(index, 0).value_or(0);
  layout.multiplexed = count >= canopen::source_multiplexed;
  for (unsigned i = 1; i <= count && i <= max_mapped && !layout.multiplexed; ++i) {
    const std::uint32_t mapping = parameter(index, static_cast<std::uint8_t>(i)).value_or(0);
    PdoField one = field(mapping);
    if (mapping == 0 || one.bits == 0) continue;
    if (layout.bits + one.bits > max_bits) break;
    one.offset = static_cast<std::uint8_t>(layout.bits);
    layout.bits += one.bits;
    layout.fields.push_back(std::move(one));
  }
  pdos_[at] = std::move(layout);
}

void NodeModel::lay_out_all() {
  pdos_.resize(device_->pdos.size());
  for (std::size_t at = 0; at < pdos_.size(); ++at) lay_out(at);
}

bool NodeModel::learn(std::uint16_t index, std::uint8_t sub_index, std::span<const std::uint8_t> value, bool written) {
  constexpr std::size_t max_bytes = 4;
  if (value.empty() || value.size() > max_bytes) return false;
  std::uint32_t number = 0;
  for (std::size_t i = value.size(); i-- > 0;) number = number << 8 | value[i];
  constexpr std::uint16_t store = 0x1010, restore = 0x1011;
  constexpr std::uint8_t communication = 2;  // 1: all parameters
  const bool of_communication = sub_index == 1 || sub_index == communication;
  if (written && index == store && of_communication && number == save_signature) stored_ = written_;
  if (written && index == restore && of_communication && number == load_signature) stored_.clear();
  if (!counts(index, sub_index) || device_->find(index) == nullptr) return false;
  if (parameter(index, sub_index) == number) return false;
  written_[key_of(index, sub_index)] = number;
  const PdoParameter parameter = pdo_of(index);
  for (std::size_t at = 0; at < pdos_.size(); ++at) {
    if (pdos_[at].direction == parameter.direction && pdos_[at].number == parameter.number) lay_out(at);
  }
  return true;
}

bool NodeModel::reset() {
  if (written_ == stored_) return false;
  written_ = stored_;
  lay_out_all();
  return true;
}

}  // namespace edsc
