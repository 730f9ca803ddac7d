/// The present mapping of a PDO, and a new one by the procedure of CiA 301 (7.5.2.36 and 7.5.2.38).
#include <fmt/format.h>

#include <algorithm>

#include "conform/case.hpp"
#include "conform/cases/pdo/remapping.hpp"
#include "conform/cases/pdo/tpdo.hpp"
#include "conform/cases/pdo/tpdo_triggers.hpp"

namespace edsc::conform {
namespace {

/// Expects a mapped object that exists and may be mapped. Fails because of the EDS if its default mapping is wrong.
void expect_mapped_object(Dut& dut, const Pdo& pdo, std::uint16_t index, std::uint8_t position,
                          const MappingValue& mapped) {
  const std::string where = label(index, position);
  if (const auto problem = problem_of(dut, pdo.direction, mapped)) {
    fail_value(dut, index, position, mapped.value(), problem->rule, where + " with " + problem->expected, problem->got);
  }
  const Entry* const entry = dut.entry(mapped.index, mapped.sub_index);
  if (mapped.is_dummy() || !canopen::readable(entry->access)) return;
  const Bytes bytes = dut.read(mapped.index, mapped.sub_index);
  dut.expect(8 * bytes.size() >= mapped.bits,
             fmt::format("{} with {} bits", label(mapped.index, mapped.sub_index), mapped.bits),
             fmt::format("{} bytes", bytes.size()));
}

/// Sets the objects to distinct values, by a stimulus or, with the permission, by SDO.
class DistinctValues {
 public:
  DistinctValues(Dut& dut, const std::vector<MappingValue>& mapping) : dut_{dut} {
    std::uint64_t salt = 0;
    for (const MappingValue& mapped : mapping) {
      if (mapped.index < 0x2000 || !dut.is_readable(mapped.index, mapped.sub_index)) continue;
      const Bytes present = dut.read(mapped.index, mapped.sub_index);
      const auto value = other_value(dut, mapped, number_of(present), ++salt);
      if (!value) continue;
      const Bytes bytes = dut.bytes_of(mapped.index, mapped.sub_index, *value);
      if (dut.stimuli().set(mapped.index, mapped.sub_index, bytes)) {
        set_.push_back({mapped, present});
      } else if (dut.is_writable(mapped.index, mapped.sub_index) && dut.allowed(Permission::application)) {
        (void)dut.download(mapped.index, mapped.sub_index, bytes);
      }
    }
  }
  DistinctValues(const DistinctValues&) = delete;
  DistinctValues& operator=(const DistinctValues&) = delete;
  ~DistinctValues() {
    for (const auto& [mapped, present] : set_) (void)dut_.stimuli().set(mapped.index, mapped.sub_index, present);
  }

 private:
  Dut& dut_;
  std::vector<std::pair<MappingValue, Bytes>> set_;
};

/// Triggers the TPDO by its event timer or by SYNC; std::nullopt if it supports neither.
std::optional<SeenFrame> make_sent(Dut& dut, const Tpdo& tpdo) {
  constexpr std::uint16_t timer_ms = 50;
  const auto timer = static_cast<std::uint16_t>(within_limits(dut, tpdo.index, timer_parameter, timer_ms));
  if (!configure(dut, tpdo, {.event_timer = timer})) {
    dut.enter(NmtState::operational);
    settle(dut, tpdo);
    const auto seen = dut.wait_for(tpdo.frames(), to_send + milliseconds{timer});
    dut.expect(seen.has_value(), tpdo.name() + " with a new mapping, by its event timer", "no frame");
    return seen;
  }
  if (!dut.has(sync_cob_id) || configure(dut, tpdo, {.type = 1})) return std::nullopt;
  SyncSource sync{dut};
  dut.enter(NmtState::operational);
  settle(dut, tpdo);
  const std::vector<SeenFrame> frames = sync.send_and_collect(tpdo.frames());
  dut.expect(!frames.empty(), tpdo.name() + " with a new mapping, at a SYNC", "no frame");
  return frames.front();
}

/// Expects the newly mapped objects in the TPDO.
void expect_sent_as_mapped(Dut& dut, const Remapping& remapping) {
  std::string reason;
  const auto tpdo = read_tpdo(dut, remapping.pdo(), reason);
  if (!tpdo) return;
  const DistinctValues values{dut, tpdo->mapping};
  const Image before = read_image(dut, tpdo->mapping);
  const auto seen = make_sent(dut, *tpdo);
  if (seen) expect_present_data(dut, *tpdo, *seen, before);
  dut.enter(NmtState::pre_operational);
  restore(dut, *tpdo);
}

/// A value that differs from the present one and that the device accepts by SDO: some objects, such as a mode of
/// operation, do not accept every value within their limits. The present value if none is found.
std::uint64_t value_taken(Dut& dut, const MappingValue& mapped, std::uint64_t present, std::uint64_t salt) {
  constexpr std::uint64_t tries = 8;
  for (std::uint64_t i = 0; i != tries; ++i) {
    const auto value = other_value(dut, mapped, present, salt + i);
    if (!value) break;
    if (!dut.download(mapped.index, mapped.sub_index, *value).done()) continue;
    dut.write(mapped.index, mapped.sub_index, present);
    return *value;
  }
  return present;
}

/// Expects that the RPDO writes the newly mapped objects.
void expect_received_as_mapped(Dut& dut, Remapping& remapping, const std::vector<MappingValue>& mapping) {
  const std::uint16_t index = remapping.pdo().communication->index;
  const auto cob_id = static_cast<std::uint32_t>(dut.read_number(index, cob_id_parameter));
  if (dut.has(index, type_parameter) && dut.read_number(index, type_parameter) < 254) {
    if (!dut.is_writable(index, type_parameter)) return;
    dut.write(index, type_parameter, within_limits(dut, index, type_parameter, event_driven));
  }
  std::vector<std::uint64_t> values;
  std::uint64_t salt = 0;
  for (const MappingValue& mapped : mapping) {
    if (mapped.index < 0x2000 || !dut.is_readable(mapped.index, mapped.sub_index)) return;
    if (!dut.is_writable(mapped.index, mapped.sub_index)) return;
    const std::uint64_t present = dut.read_number(mapped.index, mapped.sub_index);
    dut.write(mapped.index, mapped.sub_index, present);  // records the value to restore
    values.push_back(value_taken(dut, mapped, present, ++salt));
  }
  const std::uint64_t data = pack(mapping, values);
  dut.enter(NmtState::operational);
  dut.send(make_frame(cob_id, edsc::bytes_of(data, bytes_for(total_bits(mapping)))));
  dut.pass_time(silence);
  for (std::size_t i = 0; i < mapping.size(); ++i) {
    dut.expect_equal(dut.read_number(mapping[i].index, mapping[i].sub_index), values[i],
                     fmt::format("{} as received in {} with the new mapping",
                                 label(mapping[i].index, mapping[i].sub_index), pdo_label(remapping.pdo())));
  }
  dut.enter(NmtState::pre_operational);
}

void mapping_fits_dictionary(Dut& dut) {
  bool any = false;
  for (const PdoDirection direction : {PdoDirection::receive, PdoDirection::transmit}) {
    for (const Pdo* pdo : dut.pdos(direction)) {
      const std::uint16_t index = mapping_parameter_of(pdo->communication->index);
      if (!dut.has(index)) continue;
      any = true;
      const auto mapping = read_mapping(dut, pdo->communication->index);
      if (!mapping) continue;
      const unsigned highest = dut.sheet().find(index)->highest_sub_index();
      if (mapping->size() > highest) {
        fail_value(dut, index, 0, mapping->size(), "pdo-mapping-count",
                   fmt::format("{} is at most {}", label(index, 0), highest), fmt::format("{}", mapping->size()));
      }
      std::uint8_t position = 0;
      for (const MappingValue& mapped : *mapping) expect_mapped_object(dut, *pdo, index, ++position, mapped);
      if (const unsigned bits = total_bits(*mapping); bits > classical_can.bits()) {
        fail_value(dut, index, 0, pdo->bits() == bits ? mapping->size() : 0, "pdo-size",
                   pdo_label(*pdo) + fmt::format(" with at most {} bits", classical_can.bits()),
                   fmt::format("{} bits", bits));
      }
    }
  }
  if (!any) dut.not_applicable("the EDS has no mapping parameter");
}

void takes_new_mapping(Dut& dut) {
  std::vector<Remapping> all = all_remappings(dut);
  bool any = false;
  for (Remapping& remapping : all) {
    const std::vector<MappingValue> mapping = new_mapping(dut, remapping);
    if (mapping.empty()) continue;
    any = true;
    remapping.remap(mapping);
    if (remapping.is_valid()) {
      remapping.enable();
      if (remapping.pdo().direction == PdoDirection::transmit) {
        expect_sent_as_mapped(dut, remapping);
      } else if (dut.allowed(Permission::outputs | Permission::application)) {
        expect_received_as_mapped(dut, remapping, mapping);
      }
    }
    remapping.restore();
  }
  if (!any) dut.not_applicable("the EDS has no object for a PDO whose mapping is rw");
}

constexpr CaseRow new_mapping_rows[] = {
    {"3.21", "Each object that a PDO maps exists and may be mapped", "CiA 301, 7.5.2.36", Level::read, no_permission,
     mapping_fits_dictionary},
    {"3.22", "A new mapping by the procedure of CiA 301 is accepted and used", "CiA 301, 7.5.2.36", with_writes,
     with_sync, takes_new_mapping, Condition::state},
};

}  // namespace

std::span<const CaseRow> new_mapping_cases() { return new_mapping_rows; }

}  // namespace edsc::conform
