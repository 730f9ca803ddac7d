/// PDO mapping (CiA 301, 7.5.2.36 and 7.5.2.38): the present mapping, new mappings, and mappings that the device must
/// refuse.
#include <fmt/format.h>

#include <algorithm>
#include <canopen/pdo/pdo_mapping.hpp>
#include <functional>
#include <iterator>

#include "conform/cases/pdo_cases.hpp"

namespace edsc::conform::pdo_area {
namespace {

using canopen::CobId;
using Code = canopen::AbortCode;

/// An object that does not exist or cannot be mapped: step 3 of the procedure.
constexpr AbortRule wrong_object{{Code::not_mappable, Code::no_object}, {}};
/// A mapping that is not possible: step 4 of the procedure.
constexpr AbortRule wrong_mapping{{Code::pdo_length, Code::no_object, Code::not_mappable},
                                  {Code::unsupported_access, Code::general}};
/// A number of objects that sub-index 0 cannot hold may also be an invalid value.
constexpr AbortRule wrong_count{{Code::pdo_length, Code::no_object, Code::not_mappable},
                                {Code::unsupported_access, Code::invalid_value, Code::value_too_high}};

std::string_view name_of(PdoDirection direction) { return direction == PdoDirection::receive ? "RPDO" : "TPDO"; }

/// A PDO whose mapping can be changed according to the EDS, and the procedure. `put_back` restores what was found.
class Remapping {
 public:
  Remapping(Dut& dut, const Pdo& pdo, std::uint8_t capacity)
      : dut_{dut},
        pdo_{pdo},
        communication_{pdo.communication->index},
        mapping_{mapping_of(communication_)},
        capacity_{capacity},
        cob_id_{static_cast<std::uint32_t>(dut.read_number(communication_, cob_id_parameter))},
        count_{static_cast<std::uint8_t>(dut.read_number(mapping_, 0))} {
    for (std::uint8_t i = 1; i <= capacity; ++i) found_.push_back(dut.read_number(mapping_, i));
  }

  [[nodiscard]] const Pdo& pdo() const { return pdo_; }
  [[nodiscard]] std::uint8_t capacity() const { return capacity_; }
  [[nodiscard]] std::uint8_t found_count() const { return count_; }
  [[nodiscard]] bool is_valid() const { return CobId{cob_id_}.valid(); }
  /// Whether the CAN-ID can be used, so that the PDO is valid or can be enabled.
  [[nodiscard]] bool can_be_valid() const {
    return canopen::may_be_written(CobId{cob_id_ & ~CobId::invalid_bit}, true, true);
  }
  [[nodiscard]] std::vector<Mapped> found() const {
    std::vector<Mapped> mapping;
    for (std::size_t i = 0; i < std::min<std::size_t>(count_, found_.size()); ++i)
      mapping.push_back(mapped_of(found_[i]));
    return mapping;
  }
  [[nodiscard]] std::string entry_name(std::uint8_t position) const { return label(mapping_, position); }

  // ---- the five steps ----

  void disable() { dut_.write(communication_, cob_id_parameter, cob_id_ | CobId::invalid_bit); }
  void clear() { dut_.write(mapping_, 0, 0); }
  [[nodiscard]] SdoOutcome map(std::uint8_t position, const Mapped& mapped) {
    return dut_.download(mapping_, position, mapped.value());
  }
  [[nodiscard]] SdoOutcome set_count(std::uint8_t count) { return dut_.download(mapping_, 0, count); }
  void enable() { dut_.write(communication_, cob_id_parameter, cob_id_ & ~CobId::invalid_bit); }

  void begin() {
    disable();
    clear();
  }

  /// Steps 1 to 4. The device must accept them, and reads must return the new mapping.
  void remap(const std::vector<Mapped>& mapping) {
    begin();
    std::uint8_t position = 0;
    for (const Mapped& mapped : mapping) {
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

  void put_back() {
    begin();
    for (std::uint8_t i = 1; i <= capacity_; ++i) {
      if (dut_.read_number(mapping_, i) != found_[i - 1U]) dut_.write(mapping_, i, found_[i - 1U]);
    }
    if (count_ != 0) dut_.write(mapping_, 0, count_);
    dut_.write(communication_, cob_id_parameter, cob_id_);
  }

  [[nodiscard]] std::string mapping_text(std::uint8_t position, const Mapped& mapped) const {
    return fmt::format("{}: {} with {} bits written to {}", pdo_label(pdo_), label(mapped.index, mapped.sub_index),
                       mapped.bits, label(mapping_, position));
  }

  void expect_unchanged(std::uint8_t sub_index, std::uint64_t value) {
    dut_.expect_equal(dut_.read_number(mapping_, sub_index), value, label(mapping_, sub_index) + " after the refusal");
  }

 private:
  Dut& dut_;
  const Pdo& pdo_;
  std::uint16_t communication_, mapping_;
  std::uint8_t capacity_;
  std::uint32_t cob_id_;
  std::uint8_t count_;
  std::vector<std::uint64_t> found_;  ///< sub-indices 1 to capacity
};

bool is_read_and_written(const Entry* entry) {
  return entry != nullptr && canopen::readable(entry->access) && canopen::writable(entry->access);
}

/// The maximum number of mapped objects; 0 if the mapping cannot be changed.
std::uint8_t capacity_of(const Dut& dut, const Pdo& pdo) {
  const std::uint16_t communication = pdo.communication->index;
  const std::uint16_t mapping = mapping_of(communication);
  if (!is_read_and_written(dut.entry(communication, cob_id_parameter)) || !is_read_and_written(dut.entry(mapping, 0)))
    return 0;
  std::uint8_t capacity = 0;
  while (capacity < canopen::source_multiplexed - 1 &&
         is_read_and_written(dut.entry(mapping, static_cast<std::uint8_t>(capacity + 1)))) {
    ++capacity;
  }
  return std::min<std::uint8_t>(capacity, 64);
}

/// PDOs whose mapping can be changed and put back. Not applicable without one.
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

// ---- objects ----

/// The number of bits of an entry in a mapping; 0 for a length that the device cannot map.
std::uint8_t mapped_bits(const Dut& dut, const Entry& entry) {
  const unsigned bits = entry.type == nullptr ? 0 : entry.type->bits;
  const unsigned granularity = dut.sheet().information.capabilities.granularity.value_or(8);
  return bits > 64 || (granularity != 0 && bits % granularity != 0) ? std::uint8_t{0} : static_cast<std::uint8_t>(bits);
}

template <class Condition>
std::vector<Mapped> objects_where(const Dut& dut, Condition condition) {
  std::vector<Mapped> found;
  for (const Object& object : dut.sheet().objects) {
    for (const Entry& entry : object.entries) {
      const std::uint8_t bits = mapped_bits(dut, entry);
      if (bits != 0 && entry.sub_index != 0xFF && condition(entry))
        found.push_back({entry.index, entry.sub_index, bits});
    }
  }
  return found;
}

std::vector<Mapped> mappable_objects(const Dut& dut, PdoDirection direction) {
  return objects_where(dut, [direction](const Entry& entry) {
    return entry.access != canopen::Access::constant && may_carry(direction, entry);
  });
}

/// A random selection, different for each PDO and the same in each run with the same seed.
std::vector<Mapped> some_of(Dut& dut, const std::vector<Mapped>& objects) {
  constexpr std::size_t most = 4;
  std::vector<Mapped> chosen;
  std::ranges::sample(objects, std::back_inserter(chosen), most, dut.random());
  return chosen;
}

}  // namespace

// ---- the present mapping ----

namespace {

/// Expects a mapped object that exists and may be mapped. Fails because of the EDS if its default mapping is wrong.
void expect_mapped_object(Dut& dut, const Pdo& pdo, std::uint16_t index, std::uint8_t position, const Mapped& mapped) {
  const std::string where = label(index, position);
  if (const auto fault = fault_of(dut, pdo.direction, mapped)) {
    fail_value(dut, index, position, mapped.value(), fault->rule, where + " with " + fault->expected, fault->got);
  }
  const Entry* const entry = dut.entry(mapped.index, mapped.sub_index);
  if (mapped.is_dummy() || !canopen::readable(entry->access)) return;
  const Bytes bytes = dut.read(mapped.index, mapped.sub_index);
  dut.expect(8 * bytes.size() >= mapped.bits,
             fmt::format("{} with {} bits", label(mapped.index, mapped.sub_index), mapped.bits),
             fmt::format("{} bytes", bytes.size()));
}

}  // namespace

void mapping_fits_dictionary(Dut& dut) {
  bool any = false;
  for (const PdoDirection direction : {PdoDirection::receive, PdoDirection::transmit}) {
    for (const Pdo* pdo : dut.pdos(direction)) {
      const std::uint16_t index = mapping_of(pdo->communication->index);
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
      for (const Mapped& mapped : *mapping) expect_mapped_object(dut, *pdo, index, ++position, mapped);
      if (const unsigned bits = bits_of(*mapping); bits > 64) {
        fail_value(dut, index, 0, pdo->bits() == bits ? mapping->size() : 0, "pdo-size",
                   pdo_label(*pdo) + " with at most 64 bits", fmt::format("{} bits", bits));
      }
    }
  }
  if (!any) dut.not_applicable("the EDS has no mapping parameter");
}

// ---- a new mapping ----

namespace {

/// A mapping that differs from the present one, of objects that the EDS allows: the present ones in reverse order, or
/// one that is not yet mapped.
std::vector<Mapped> new_mapping(const Dut& dut, const Remapping& remapping) {
  const std::vector<Mapped> present = remapping.found();
  std::vector<Mapped> reversed{present.rbegin(), present.rend()};
  if (reversed != present) return reversed;
  for (const Mapped& mapped : mappable_objects(dut, remapping.pdo().direction)) {
    if (std::ranges::find(present, mapped) == present.end()) return {mapped};
  }
  return reversed;
}

/// Sets the objects to distinct values, by a stimulus or, with the permission, by SDO.
class DistinctValues {
 public:
  DistinctValues(Dut& dut, const std::vector<Mapped>& mapping) : dut_{dut} {
    std::uint64_t salt = 0;
    for (const Mapped& mapped : mapping) {
      const Entry* const entry = dut.entry(mapped.index, mapped.sub_index);
      if (mapped.index < 0x2000 || entry == nullptr || !canopen::readable(entry->access)) continue;
      const Bytes present = dut.read(mapped.index, mapped.sub_index);
      const auto value = other_value(dut, mapped, number_of(present), ++salt);
      if (!value) continue;
      const Bytes bytes = dut.bytes_of(mapped.index, mapped.sub_index, *value);
      if (dut.stimuli().set(mapped.index, mapped.sub_index, bytes)) {
        set_.push_back({mapped, present});
      } else if (canopen::writable(entry->access) && dut.allowed(Permission::application)) {
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
  std::vector<std::pair<Mapped, Bytes>> set_;
};

/// Triggers the TPDO by its event timer or by SYNC; std::nullopt if it supports neither.
std::optional<SeenFrame> make_sent(Dut& dut, const Tpdo& tpdo) {
  constexpr std::uint16_t timer_ms = 50;
  const auto timer = static_cast<std::uint16_t>(within_limits(dut, tpdo.index, timer_parameter, timer_ms));
  if (!configure(dut, tpdo, {.event_timer = timer})) {
    dut.enter(NmtState::operational);
    settle(dut, tpdo);
    const auto seen = dut.wait_for(tpdo.frames(), to_answer + milliseconds{timer});
    dut.expect(seen.has_value(), tpdo.name() + " with a new mapping, by its event timer", "no frame");
    return seen;
  }
  if (!dut.has(0x1005) || configure(dut, tpdo, {.type = 1})) return std::nullopt;
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
  put_back(dut, *tpdo);
}

/// A value that differs from the present one and that the device accepts by SDO: some objects, such as a mode of
/// operation, do not accept every value within their limits. The present value if none is found.
std::uint64_t value_taken(Dut& dut, const Mapped& mapped, std::uint64_t present, std::uint64_t salt) {
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
void expect_received_as_mapped(Dut& dut, Remapping& remapping, const std::vector<Mapped>& mapping) {
  const std::uint16_t index = remapping.pdo().communication->index;
  const auto cob_id = static_cast<std::uint32_t>(dut.read_number(index, cob_id_parameter));
  if (dut.has(index, type_parameter) && dut.read_number(index, type_parameter) < 254) {
    if (!canopen::writable(dut.entry(index, type_parameter)->access)) return;
    dut.write(index, type_parameter, event_driven);
  }
  std::vector<std::uint64_t> values;
  std::uint64_t salt = 0;
  for (const Mapped& mapped : mapping) {
    const Entry* const entry = dut.entry(mapped.index, mapped.sub_index);
    if (entry == nullptr || mapped.index < 0x2000 || !is_read_and_written(entry)) return;
    const std::uint64_t present = dut.read_number(mapped.index, mapped.sub_index);
    dut.write(mapped.index, mapped.sub_index, present);  // records the value to put back
    values.push_back(value_taken(dut, mapped, present, ++salt));
  }
  const std::uint64_t data = pack(mapping, values);
  Bytes bytes((bits_of(mapping) + 7) / 8);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(data >> 8 * i);
  dut.enter(NmtState::operational);
  dut.send(make_frame(cob_id, bytes));
  dut.pass_time(silence);
  for (std::size_t i = 0; i < mapping.size(); ++i) {
    dut.expect_equal(dut.read_number(mapping[i].index, mapping[i].sub_index), values[i],
                     fmt::format("{} as received in {} with the new mapping",
                                 label(mapping[i].index, mapping[i].sub_index), pdo_label(remapping.pdo())));
  }
  dut.enter(NmtState::pre_operational);
}

}  // namespace

void takes_new_mapping(Dut& dut) {
  std::vector<Remapping> all = all_remappings(dut);
  bool any = false;
  for (Remapping& remapping : all) {
    const std::vector<Mapped> mapping = new_mapping(dut, remapping);
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
    remapping.put_back();
  }
  if (!any) dut.not_applicable("the EDS has no object for a PDO whose mapping is rw");
}

// ---- without the procedure ----

namespace {

/// Runs a check for each valid PDO that maps objects; enables it if necessary. Not applicable without one.
template <class Check>
void for_each_active(Dut& dut, Check check) {
  std::vector<Remapping> all = all_remappings(dut);
  bool any = false;
  for (Remapping& remapping : all) {
    if (remapping.found_count() == 0 || !remapping.can_be_valid() || remapping.found_count() > remapping.capacity())
      continue;
    const std::vector<Mapped> mapping = new_mapping(dut, remapping);
    if (mapping.empty()) continue;
    any = true;
    if (!remapping.is_valid()) remapping.enable();
    check(remapping, mapping);
    remapping.put_back();
  }
  if (!any) dut.not_applicable("no PDO whose mapping is rw maps an object and has a usable CAN-ID");
}

}  // namespace

void refuses_entry_of_active_mapping(Dut& dut) {
  for_each_active(dut, [&](Remapping& remapping, const std::vector<Mapped>& mapping) {
    const SdoOutcome outcome = remapping.map(1, mapping.front());
    dut.expect_abort(outcome, abort_rule::mapping_in_use,
                     remapping.mapping_text(1, mapping.front()) + " while the PDO is valid");
    remapping.expect_unchanged(1, remapping.found().front().value());
  });
}

void refuses_mapping_of_valid_pdo(Dut& dut) {
  for_each_active(dut, [&](Remapping& remapping, const std::vector<Mapped>& mapping) {
    SdoOutcome outcome = remapping.set_count(0);
    std::string what = "0 written to " + remapping.entry_name(0);
    for (std::uint8_t i = 1; outcome.done() && i <= mapping.size(); ++i) {
      outcome = remapping.map(i, mapping[i - 1U]);
      what = remapping.mapping_text(i, mapping[i - 1U]);
    }
    if (outcome.done()) {
      outcome = remapping.set_count(static_cast<std::uint8_t>(mapping.size()));
      what = fmt::format("{} written to {}", mapping.size(), remapping.entry_name(0));
    }
    dut.expect_abort(outcome, abort_rule::mapping_in_use, what + " while the PDO is valid");
  });
}

// ---- impossible mappings ----

void refuses_too_many_objects(Dut& dut) {
  for (Remapping& remapping : all_remappings(dut)) {
    remapping.begin();
    const auto count = static_cast<std::uint8_t>(remapping.capacity() + 1);
    dut.expect_abort(
        remapping.set_count(count), wrong_count,
        fmt::format("{} written to {}, which has {} entries", count, remapping.entry_name(0), remapping.capacity()));
    remapping.expect_unchanged(0, 0);
    remapping.put_back();
  }
}

namespace {

/// The fewest objects with more than 64 bits in total; repeats objects if there are not enough. Empty if the PDO cannot
/// map that number.
std::vector<Mapped> too_long_mapping(const Dut& dut, const Remapping& remapping) {
  std::vector<Mapped> objects = mappable_objects(dut, remapping.pdo().direction);
  std::ranges::stable_sort(objects, std::ranges::greater{}, &Mapped::bits);
  std::vector<Mapped> mapping;
  for (std::size_t i = 0; !objects.empty() && bits_of(mapping) <= 64; ++i) {
    if (mapping.size() == remapping.capacity()) return {};
    mapping.push_back(objects[i % objects.size()]);
  }
  return mapping;
}

}  // namespace

void refuses_too_many_bits(Dut& dut) {
  std::string reason = "the EDS does not allow a mapping of more than 64 bits";
  bool any = false;
  for (Remapping& remapping : all_remappings(dut)) {
    const std::vector<Mapped> mapping = too_long_mapping(dut, remapping);
    if (mapping.empty()) continue;
    remapping.begin();
    std::uint8_t count = 0;
    SdoOutcome outcome;
    while (outcome.done() && count < mapping.size()) {
      outcome = remapping.map(static_cast<std::uint8_t>(count + 1), mapping[count]);
      ++count;
    }
    const bool is_again = std::ranges::count(mapping, mapping[count - 1U]) > 1;
    if (!outcome.done() && count < mapping.size() && is_again) {
      reason = fmt::format("{} does not map {} twice", pdo_label(remapping.pdo()), objects_text({mapping[count - 1U]}));
    } else {
      dut.expect(outcome.done() || count == mapping.size(), remapping.mapping_text(count, mapping[count - 1U]),
                 outcome_text(outcome));
      if (outcome.done()) outcome = remapping.set_count(count);
      dut.expect_abort(outcome, wrong_mapping,
                       fmt::format("{} with {} bits", pdo_label(remapping.pdo()), bits_of(mapping)));
      remapping.expect_unchanged(0, 0);
      any = true;
    }
    remapping.put_back();
  }
  if (!any) dut.not_applicable(reason);
}

// ---- which objects ----

namespace {

void takes_objects(Dut& dut, PdoDirection direction, const std::vector<Mapped>& objects, const char* none) {
  std::vector<Remapping> all = remappings(dut, {direction});
  if (objects.empty()) dut.not_applicable(none);
  for (Remapping& remapping : all) {
    for (const Mapped& mapped : some_of(dut, objects)) remapping.remap({mapped});
    remapping.put_back();
  }
}

/// The device refuses the entry or, at the latest, the mapping as a whole.
void refuses_objects(Dut& dut, PdoDirection direction, const std::vector<Mapped>& objects, const char* none) {
  std::vector<Remapping> all = remappings(dut, {direction});
  if (objects.empty()) dut.not_applicable(none);
  for (Remapping& remapping : all) {
    for (const Mapped& mapped : some_of(dut, objects)) {
      remapping.begin();
      const SdoOutcome outcome = remapping.map(1, mapped);
      if (outcome.done()) {
        dut.expect_abort(remapping.set_count(1), wrong_mapping,
                         remapping.mapping_text(1, mapped) + ", then 1 to " + remapping.entry_name(0));
      } else {
        dut.expect_abort(outcome, wrong_object, remapping.mapping_text(1, mapped));
      }
      remapping.expect_unchanged(0, 0);
    }
    remapping.put_back();
  }
}

std::vector<Mapped> with_access(const Dut& dut, canopen::Access first, canopen::Access second) {
  return objects_where(
      dut, [=](const Entry& entry) { return entry.pdo_mapping && (entry.access == first || entry.access == second); });
}

std::vector<Mapped> outputs(const Dut& dut) { return with_access(dut, canopen::Access::rww, canopen::Access::wo); }
std::vector<Mapped> inputs(const Dut& dut) { return with_access(dut, canopen::Access::rwr, canopen::Access::ro); }
std::vector<Mapped> unmappable(const Dut& dut) {
  return objects_where(dut, [](const Entry& entry) { return !entry.pdo_mapping; });
}

constexpr const char* no_output = "the EDS has no object with PDOMapping=1 that is rww or wo";
constexpr const char* no_input = "the EDS has no object with PDOMapping=1 that is rwr or ro";
constexpr const char* no_unmappable = "the EDS has no object with PDOMapping=0";

}  // namespace

void takes_output_in_rpdo(Dut& dut) { takes_objects(dut, PdoDirection::receive, outputs(dut), no_output); }
void refuses_input_in_rpdo(Dut& dut) { refuses_objects(dut, PdoDirection::receive, inputs(dut), no_input); }
void refuses_unmappable_in_rpdo(Dut& dut) {
  refuses_objects(dut, PdoDirection::receive, unmappable(dut), no_unmappable);
}
void takes_input_in_tpdo(Dut& dut) { takes_objects(dut, PdoDirection::transmit, inputs(dut), no_input); }
void refuses_output_in_tpdo(Dut& dut) { refuses_objects(dut, PdoDirection::transmit, outputs(dut), no_output); }
void refuses_unmappable_in_tpdo(Dut& dut) {
  refuses_objects(dut, PdoDirection::transmit, unmappable(dut), no_unmappable);
}

void takes_dummy_in_rpdo(Dut& dut) {
  std::vector<Mapped> dummies;
  const unsigned granularity = dut.sheet().information.capabilities.granularity.value_or(8);
  for (const std::uint16_t index : dut.sheet().dummies) {
    if (index >= std::size(canopen::dummy_bits)) continue;
    const std::uint8_t bits = canopen::dummy_bits[index];
    if (bits != 0 && (granularity == 0 || bits % granularity == 0)) dummies.push_back({index, 0, bits});
  }
  takes_objects(dut, PdoDirection::receive, dummies, "the EDS has no dummy object in [DummyUsage]");
}

}  // namespace edsc::conform::pdo_area
