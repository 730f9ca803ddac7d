/// Mappings that the device must refuse, and objects that it must accept (CiA 301, 7.5.2.36 and 7.5.2.38).
#include <fmt/format.h>

#include <algorithm>
#include <canopen/pdo/pdo_mapping.hpp>
#include <functional>
#include <iterator>

#include "conform/case.hpp"
#include "conform/cases/pdo/remapping.hpp"

namespace edsc::conform {
namespace {

using Code = canopen::AbortCode;

/// An object that does not exist or cannot be mapped: step 3 of the procedure.
constexpr AbortRule wrong_object{{Code::not_mappable, Code::no_object}, {}};
/// A mapping that is not possible: step 4 of the procedure.
constexpr AbortRule wrong_mapping{{Code::pdo_length, Code::no_object, Code::not_mappable},
                                  {Code::unsupported_access, Code::general}};
/// A number of objects that sub-index 0 cannot hold may also be an invalid value.
constexpr AbortRule wrong_count{{Code::pdo_length, Code::no_object, Code::not_mappable},
                                {Code::unsupported_access, Code::invalid_value, Code::value_too_high}};

/// Runs a check for each valid PDO that maps objects; enables it if necessary. Not applicable without one.
template <class Check>
void for_each_active(Dut& dut, Check check) {
  std::vector<Remapping> all = all_remappings(dut);
  bool any = false;
  for (Remapping& remapping : all) {
    if (remapping.found_count() == 0 || !remapping.can_be_valid() || remapping.found_count() > remapping.capacity())
      continue;
    const std::vector<MappingValue> mapping = new_mapping(dut, remapping);
    if (mapping.empty()) continue;
    any = true;
    if (!remapping.is_valid()) remapping.enable();
    check(remapping, mapping);
    remapping.restore();
  }
  if (!any) dut.not_applicable("no PDO whose mapping is rw maps an object and has a usable CAN-ID");
}

/// The fewest objects with more than 64 bits in total; repeats objects if there are not enough. Empty if the PDO cannot
/// map that number.
std::vector<MappingValue> too_long_mapping(const Dut& dut, const Remapping& remapping) {
  std::vector<MappingValue> objects = mappable_objects(dut, remapping.pdo().direction);
  std::ranges::stable_sort(objects, std::ranges::greater{}, &MappingValue::bits);
  std::vector<MappingValue> mapping;
  for (std::size_t i = 0; !objects.empty() && total_bits(mapping) <= classical_can.bits(); ++i) {
    if (mapping.size() == remapping.capacity()) return {};
    mapping.push_back(objects[i % objects.size()]);
  }
  return mapping;
}

/// A random selection, different for each PDO and the same in each run with the same seed.
std::vector<MappingValue> some_of(Dut& dut, const std::vector<MappingValue>& objects) {
  constexpr std::size_t most = 4;
  std::vector<MappingValue> chosen;
  std::ranges::sample(objects, std::back_inserter(chosen), most, dut.random());
  return chosen;
}

/// Objects of the EDS, and the reason if it has none.
struct ObjectSet {
  std::vector<MappingValue> (*objects)(const Dut&);
  const char* none;
};

std::vector<MappingValue> with_access(const Dut& dut, canopen::Access first, canopen::Access second) {
  return objects_where(
      dut, [=](const Entry& entry) { return entry.pdo_mapping && (entry.access == first || entry.access == second); });
}

constexpr ObjectSet outputs{[](const Dut& dut) { return with_access(dut, canopen::Access::rww, canopen::Access::wo); },
                            "the EDS has no object with PDOMapping=1 that is rww or wo"};
constexpr ObjectSet inputs{[](const Dut& dut) { return with_access(dut, canopen::Access::rwr, canopen::Access::ro); },
                           "the EDS has no object with PDOMapping=1 that is rwr or ro"};
constexpr ObjectSet unmappable{
    [](const Dut& dut) { return objects_where(dut, [](const Entry& entry) { return !entry.pdo_mapping; }); },
    "the EDS has no object with PDOMapping=0"};

std::vector<MappingValue> dummy_objects(const Dut& dut) {
  std::vector<MappingValue> dummies;
  const unsigned granularity = dut.sheet().information.capabilities.granularity.value_or(8);
  for (const std::uint16_t index : dut.sheet().dummies) {
    if (index >= std::size(canopen::dummy_bits)) continue;
    const std::uint8_t bits = canopen::dummy_bits[index];
    if (bits != 0 && (granularity == 0 || bits % granularity == 0)) dummies.push_back({index, 0, bits});
  }
  return dummies;
}

constexpr ObjectSet dummies{dummy_objects, "the EDS has no dummy object in [DummyUsage]"};

void takes_objects(Dut& dut, PdoDirection direction, const ObjectSet* set) {
  std::vector<Remapping> all = remappings(dut, {direction});
  const std::vector<MappingValue> objects = set->objects(dut);
  if (objects.empty()) dut.not_applicable(set->none);
  for (Remapping& remapping : all) {
    for (const MappingValue& mapped : some_of(dut, objects)) remapping.remap({mapped});
    remapping.restore();
  }
}

/// The device refuses the entry or, at the latest, the mapping as a whole.
void refuses_objects(Dut& dut, PdoDirection direction, const ObjectSet* set) {
  std::vector<Remapping> all = remappings(dut, {direction});
  const std::vector<MappingValue> objects = set->objects(dut);
  if (objects.empty()) dut.not_applicable(set->none);
  for (Remapping& remapping : all) {
    for (const MappingValue& mapped : some_of(dut, objects)) {
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
    remapping.restore();
  }
}

// ---- without the procedure ----

void refuses_entry_of_active_mapping(Dut& dut) {
  for_each_active(dut, [&](Remapping& remapping, const std::vector<MappingValue>& mapping) {
    const SdoOutcome outcome = remapping.map(1, mapping.front());
    dut.expect_abort(outcome, abort_rule::mapping_in_use,
                     remapping.mapping_text(1, mapping.front()) + " while the PDO is valid");
    remapping.expect_unchanged(1, remapping.found().front().value());
  });
}

void refuses_mapping_of_valid_pdo(Dut& dut) {
  for_each_active(dut, [&](Remapping& remapping, const std::vector<MappingValue>& mapping) {
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
    remapping.restore();
  }
}

void refuses_too_many_bits(Dut& dut) {
  std::string reason = "the EDS does not allow a mapping of more than 64 bits";
  bool any = false;
  for (Remapping& remapping : all_remappings(dut)) {
    const std::vector<MappingValue> mapping = too_long_mapping(dut, remapping);
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
                       fmt::format("{} with {} bits", pdo_label(remapping.pdo()), total_bits(mapping)));
      remapping.expect_unchanged(0, 0);
      any = true;
    }
    remapping.restore();
  }
  if (!any) dut.not_applicable(reason);
}

constexpr CaseRow refused_mapping_rows[] = {
    {"3.23", "A mapping entry is not changed while the PDO is valid and maps objects", "CiA 301, 7.5.2.36", with_writes,
     no_permission, refuses_entry_of_active_mapping},
    {"3.24", "A mapping is not changed while the PDO is valid", "CiA 301, 7.5.2.36", with_writes, no_permission,
     refuses_mapping_of_valid_pdo},
    {"3.25", "More objects than the mapping parameter has entries are refused", "CiA 301, 7.5.2.36", with_writes,
     no_permission, refuses_too_many_objects},
    {"3.26", "A mapping of more than 64 bits is refused", "CiA 301, 7.5.2.36", with_writes, no_permission,
     refuses_too_many_bits},
    {"3.27", "An RPDO can map an object that is rww or wo", "CiA 301, 7.5.2.36", with_writes, no_permission,
     with<takes_objects, PdoDirection::receive, &outputs>},
    {"3.28", "An RPDO does not map an object that is rwr or ro", "CiA 301, 7.5.2.36", with_writes, no_permission,
     with<refuses_objects, PdoDirection::receive, &inputs>},
    {"3.29", "An RPDO does not map an object with PDOMapping=0", "CiA 301, 7.5.2.36", with_writes, no_permission,
     with<refuses_objects, PdoDirection::receive, &unmappable>},
    {"3.30", "A TPDO can map an object that is rwr or ro", "CiA 301, 7.5.2.38", with_writes, no_permission,
     with<takes_objects, PdoDirection::transmit, &inputs>},
    {"3.31", "A TPDO does not map an object that is rww or wo", "CiA 301, 7.5.2.38", with_writes, no_permission,
     with<refuses_objects, PdoDirection::transmit, &outputs>},
    {"3.32", "A TPDO does not map an object with PDOMapping=0", "CiA 301, 7.5.2.38", with_writes, no_permission,
     with<refuses_objects, PdoDirection::transmit, &unmappable>},
    {"3.33", "An RPDO can map a dummy object", "CiA 301, 7.4.7.1", with_writes, no_permission,
     with<takes_objects, PdoDirection::receive, &dummies>},
};

}  // namespace

std::span<const CaseRow> refused_mapping_cases() { return refused_mapping_rows; }

}  // namespace edsc::conform
