#include "conform/cases/pdo/remapping.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <canopen/pdo/pdo_mapping.hpp>

namespace edsc::conform {
namespace {

bool is_read_and_written(const Dut& dut, std::uint16_t index, std::uint8_t sub_index) {
  return dut.is_readable(index, sub_index) && dut.is_writable(index, sub_index);
}

/// The maximum number of mapped objects; 0 if the mapping cannot be changed.
std::uint8_t capacity_of(const Dut& dut, const Pdo& pdo) {
  const std::uint16_t communication = pdo.communication->index;
  const std::uint16_t mapping = mapping_parameter_of(communication);
  if (!is_read_and_written(dut, communication, cob_id_parameter) || !is_read_and_written(dut, mapping, 0)) return 0;
  std::uint8_t capacity = 0;
  while (capacity < canopen::source_multiplexed - 1 &&
         is_read_and_written(dut, mapping, static_cast<std::uint8_t>(capacity + 1))) {
    ++capacity;
  }
  return std::min(capacity, classical_can.objects);
}

std::string_view name_of(PdoDirection direction) { return direction == PdoDirection::receive ? "RPDO" : "TPDO"; }

// ---- objects ----

/// The number of bits of an entry in a mapping; 0 for a length that the device cannot map.
std::uint8_t mapped_bits(const Dut& dut, const Entry& entry) {
  const unsigned bits = entry.type == nullptr ? 0 : entry.type->bits;
  const unsigned granularity = dut.sheet().information.capabilities.granularity.value_or(8);
  return bits > classical_can.bits() || (granularity != 0 && bits % granularity != 0) ? std::uint8_t{0}
                                                                                      : static_cast<std::uint8_t>(bits);
}

}  // namespace

Remapping::Remapping(Dut& dut, const Pdo& pdo, std::uint8_t capacity)
    : dut_{dut},
      pdo_{pdo},
      communication_{pdo.communication->index},
      mapping_{mapping_parameter_of(communication_)},
      capacity_{capacity},
      cob_id_{static_cast<std::uint32_t>(dut.read_number(communication_, cob_id_parameter))},
      count_{static_cast<std::uint8_t>(dut.read_number(mapping_, 0))} {
  for (std::uint8_t i = 1; i <= capacity; ++i) found_.push_back(dut.read_number(mapping_, i));
}

std::vector<MappingValue> Remapping::found() const {
  std::vector<MappingValue> mapping;
  for (std::size_t i = 0; i < std::min<std::size_t>(count_, found_.size()); ++i)
    mapping.push_back(MappingValue::of(static_cast<std::uint32_t>(found_[i])));
  return mapping;
}
void Remapping::remap(const std::vector<MappingValue>& mapping) {
  begin();
  std::uint8_t position = 0;
  for (const MappingValue& mapped : mapping) {
    ++position;
    dut_.expect_done(map(position, mapped), mapping_text(position, mapped));
  }
  const auto count = static_cast<std::uint8_t>(mapping.size());
  dut_.expect_done(set_count(count), fmt::format("{} written to {}", count, label(mapping_, 0)));
  dut_.expect_equal(dut_.read_number(mapping_, 0), count, label(mapping_, 0) + " after it was written");
  for (position = 1; position <= count; ++position) {
    dut_.expect_equal(dut_.read_number(mapping_, position), mapping[position - 1U].value(),
                      label(mapping_, position) + " after it was written");
  }
}

void Remapping::restore() {
  begin();
  for (std::uint8_t i = 1; i <= capacity_; ++i) {
    if (dut_.read_number(mapping_, i) != found_[i - 1U]) dut_.write(mapping_, i, found_[i - 1U]);
  }
  if (count_ != 0) dut_.write(mapping_, 0, count_);
  dut_.write(communication_, cob_id_parameter, cob_id_);
}

std::string Remapping::mapping_text(std::uint8_t position, const MappingValue& mapped) const {
  return fmt::format("{}: {} with {} bits written to {}", pdo_label(pdo_), label(mapped.index, mapped.sub_index),
                     mapped.bits, label(mapping_, position));
}

void Remapping::expect_unchanged(std::uint8_t sub_index, std::uint64_t value) {
  dut_.expect_equal(dut_.read_number(mapping_, sub_index), value, label(mapping_, sub_index) + " after the refusal");
}

std::vector<Remapping> remappings(Dut& dut, std::initializer_list<PdoDirection> directions) {
  std::vector<Remapping> found;
  std::string reason = fmt::format("the EDS has no {} whose mapping and COB-ID are rw",
                                   directions.size() == 1 ? name_of(*directions.begin()) : "PDO");
  dut.enter(NmtState::pre_operational);
  for (const PdoDirection direction : directions) {
    for (const Pdo* pdo : dut.pdos(direction)) {
      const std::uint8_t capacity = pdo->dynamic ? capacity_of(dut, *pdo) : std::uint8_t{0};
      if (capacity == 0) continue;
      const auto mapping = read_mapping(dut, pdo->communication->index);
      if (!mapping) {
        reason = pdo_label(*pdo) + " is a multiplex PDO";
      } else if (auto why = reason_against(dut, *pdo, *mapping)) {
        reason = *why;
      } else {
        found.emplace_back(dut, *pdo, capacity);
      }
    }
  }
  if (found.empty()) dut.not_applicable(reason);
  return found;
}

std::vector<Remapping> all_remappings(Dut& dut) {
  return remappings(dut, {PdoDirection::receive, PdoDirection::transmit});
}

std::vector<MappingValue> objects_where(const Dut& dut, const std::function<bool(const Entry&)>& condition) {
  std::vector<MappingValue> found;
  for (const Object& object : dut.sheet().objects) {
    for (const Entry& entry : object.entries) {
      const std::uint8_t bits = mapped_bits(dut, entry);
      if (bits != 0 && entry.sub_index != 0xFF && condition(entry))
        found.push_back({entry.index, entry.sub_index, bits});
    }
  }
  return found;
}

std::vector<MappingValue> mappable_objects(const Dut& dut, PdoDirection direction) {
  return objects_where(dut, [direction](const Entry& entry) {
    return entry.access != canopen::Access::constant && may_carry(direction, entry);
  });
}

std::vector<MappingValue> new_mapping(const Dut& dut, const Remapping& remapping) {
  const std::vector<MappingValue> present = remapping.found();
  std::vector<MappingValue> reversed{present.rbegin(), present.rend()};
  if (reversed != present) return reversed;
  for (const MappingValue& mapped : mappable_objects(dut, remapping.pdo().direction)) {
    if (std::ranges::find(present, mapped) == present.end()) return {mapped};
  }
  return reversed;
}

}  // namespace edsc::conform
