/// Area 4, continued: what the EDS declares writable can be written (CiA 301, 7.4.5): with the present values, with
/// DefaultValue and limits, and with another value. Parameters of 1000h to 1FFFh are written in the sequence of CiA
/// 301, 7.5.2: a COB-ID disables its service while the other parameters of the service change.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <canopen/base/abort_code.hpp>
#include <canopen/can/cob_id.hpp>
#include <canopen/od/access.hpp>
#include <canopen/pdo/pdo_parameters.hpp>
#include <canopen/sync/sync.hpp>
#include <optional>
#include <string>
#include <vector>

#include "configure/configuration_plan.hpp"
#include "conform/case.hpp"
#include "conform/cases/shared/entry_results.hpp"
#include "conform/cases/shared/entry_values.hpp"
#include "conform/dut/dut.hpp"
#include "device/index_range.hpp"
#include "device/pdo/locked_parameters.hpp"

namespace edsc::conform {
namespace {

using canopen::AbortCode;
using canopen::CobId;
using canopen::DataClass;

// Which entries

/// Whether an entry belongs to a PDO whose mapping in the EDS is wrong: `edsc check` reports the mapping.
bool is_of_wrong_pdo(const Device& sheet, const LiveEntry& entry) {
  return std::ranges::any_of(sheet.pdos, [&](const Pdo& pdo) {
    const auto has = [&](const Object* object) { return object != nullptr && object->index == entry.index; };
    return pdo.broken && (has(pdo.communication) || has(pdo.mapping));
  });
}

bool is_written(const Dut& dut, const LiveEntry& entry) {
  if (!is_writable(entry) || entry.type == nullptr || is_domain(entry)) return false;
  if (is_of_wrong_pdo(dut.sheet(), entry)) return false;
  if (is_left_out(entry) || sets_node_id_or_bit_rate(entry)) return false;
  // The value of a write-only entry cannot be restored.
  return (flags_of(dut.sheet(), entry) & refuse_write_flag) == 0 && (is_readable(entry) || dut.simulated());
}

bool is_mapping(const LiveEntry& entry) { return contains(mapping_parameters, entry.index); }

/// Values that the device changes on its own, or that only count errors.
bool is_live(const LiveEntry& entry) {
  return entry.index == error_register || entry.index == status_register || entry.index == high_resolution_time ||
         (entry.entry->pdo_mapping && is_application(entry));
}

bool starts_sync(const LiveEntry& entry) {
  return entry.index == sync_cob_id || entry.index == sync_period || entry.index == sync_window ||
         entry.index == sync_overflow;
}

bool is_same_element(const Entry& a, const Entry& b) {
  const auto bits = [](const std::optional<Value>& value) { return value ? std::optional{value->bits} : std::nullopt; };
  return a.type == b.type && a.access == b.access && bits(a.low_limit) == bits(b.low_limit) &&
         bits(a.high_limit) == bits(b.high_limit);
}

/// Whether an element of a long ARRAY is between equal ones, which are tested.
bool is_one_of_many(const Dut& dut, const LiveEntry& entry) {
  if (entry.sub_index < 3 || is_communication(entry)) return false;
  const Entry* const before = dut.entry(entry.index, static_cast<std::uint8_t>(entry.sub_index - 1));
  const Entry* const after = dut.entry(entry.index, static_cast<std::uint8_t>(entry.sub_index + 1));
  return before != nullptr && after != nullptr && is_same_element(*entry.entry, *before) &&
         is_same_element(*entry.entry, *after);
}

// The rule of `edsc check` for an entry that no write can change

bool is_locked(const Device& sheet, const ConditionalParameter& parameter, const LiveEntry& entry) {
  return std::ranges::any_of(locked_in(sheet, parameter), [&](const LockedParameter& locked) {
    if (locked.entry->index != entry.index) return false;
    return is_mapping(entry) || locked.entry->sub_index == entry.sub_index;
  });
}

bool is_of_static_mapping(const Device& sheet, const LiveEntry& entry) {
  return is_mapping(entry) && std::ranges::any_of(sheet.pdos, [&](const Pdo& pdo) {
           return pdo.mapping != nullptr && pdo.mapping->index == entry.index && !pdo.dynamic;
         });
}

/// Returns std::nullopt if no rule of `edsc check` explains that the device refuses the entry.
std::optional<AnyRule> rule_of(const Dut& dut, const LiveEntry& entry) {
  const Device& sheet = dut.sheet();
  for (const ConditionalParameter& parameter : conditional_parameters()) {
    if (is_locked(sheet, parameter, entry))
      return is_implied(sheet, parameter) ? AnyRule{"implied-option"} : AnyRule{"never-writable"};
  }
  if (is_of_static_mapping(sheet, entry)) return AnyRule{"never-writable"};
  if (entry.index == sync_overflow && dut.has(sync_period) && !dut.is_writable(sync_period))
    return AnyRule{"never-writable"};
  if (entry.index == default_sdo_server) return AnyRule{"standard-access"};
  return std::nullopt;
}

/// Failures of entries whose EDS is right, and of those whose EDS is not.
class WriteResults {
 public:
  explicit WriteResults(Dut& dut) : dut_{dut}, results_{dut} {}

  void count() { results_.count(); }
  [[nodiscard]] bool lost() const { return results_.lost(); }
  void warn(const LiveEntry& entry, const std::string& text) { results_.add_warning(entry, text); }
  void fail(const LiveEntry& entry, const std::string& text) {
    const std::optional<AnyRule> rule = rule_of(dut_, entry);
    if (!rule) return results_.add_failure(entry, text);
    if (!rule_) rule_ = rule;
    if (by_sheet_.empty()) by_sheet_ = fmt::format("{}: {}", title(entry), text);
  }
  void finish(const std::string& expected, const std::string& why_none) {
    results_.finish(expected, why_none);
    if (rule_) dut_.fail_by_sheet(*rule_, expected, by_sheet_);
  }

 private:
  Dut& dut_;
  EntryResults results_;
  std::optional<AnyRule> rule_;
  std::string by_sheet_;
};

// Values that CiA 301 allows

bool is_cob_id(const LiveEntry& entry) {
  if (canopen::find_cob_id_entries(entry.index, entry.sub_index)) return true;
  const bool client = entry.index >= 0x1280 && entry.index <= 0x12FF && (entry.sub_index == 1 || entry.sub_index == 2);
  return client || (entry.index == emergency_consumer && entry.sub_index != 0);
}

bool is_pdo_communication(const LiveEntry& entry) {
  return (entry.index & 0xFE00) == 0x1400 || (entry.index & 0xFE00) == 0x1800;
}

bool is_receive(const LiveEntry& entry) { return (entry.index & 0xFE00) == 0x1400; }

/// Whether CiA 301 allows this value in any state of the device. COB-IDs and mappings have cases of their own.
bool is_allowed(const LiveEntry& entry, std::uint64_t value) {
  const auto number = static_cast<std::uint32_t>(value);
  if (is_cob_id(entry) || is_mapping(entry) || entry.index == consumer_heartbeat) return false;
  switch (entry.index) {
    case sync_period: return canopen::is_sync_period(number);
    case sync_overflow: return canopen::is_sync_overflow(number);
    case error_behavior: return entry.sub_index == 0 || number <= 2;
    case high_resolution_time: return true;
    default: break;
  }
  if (!is_pdo_communication(entry)) return true;
  if (entry.sub_index == 2) return canopen::transmission_type_is_legal(is_receive(entry), number);
  return entry.sub_index != 6 || number <= 240;
}

/// A COB-ID with a CAN-ID that CiA 301 does not restrict, and the other bits of the present one. Some devices keep the
/// lowest seven bits, which are the node-ID: they stay as they are if the CAN-ID is not restricted.
std::uint32_t other_cob_id(std::uint32_t present) {
  constexpr std::uint32_t above_sdo = 0x680, restricted = 0x6E0, other = 0x6A1;  // nothing is predefined between them
  const std::uint32_t flags = present & ~std::uint32_t{CobId::extended_bit | 0x1FFF'FFFFU};
  const std::uint32_t can_id = above_sdo | (present & canopen::highest_node_id);
  return flags | (can_id < restricted && can_id != CobId{present}.can_id() ? can_id : other);
}

/// A heartbeat consumer time of one second for a node that 1016h does not monitor.
std::optional<std::uint32_t> other_consumer_time(Dut& dut) {
  std::array<bool, 128> used{};
  used[dut.node().value()] = true;
  for (unsigned sub_index = 1; dut.has(consumer_heartbeat, static_cast<std::uint8_t>(sub_index)); ++sub_index) {
    const SdoOutcome outcome = dut.upload(consumer_heartbeat, static_cast<std::uint8_t>(sub_index));
    if (outcome.done()) used[(number_of(outcome.bytes) >> 16) & 0x7F] = true;
    if (sub_index == 127) break;
  }
  for (std::uint32_t node_id = 127; node_id > 0; --node_id) {
    if (!used[node_id]) return node_id << 16 | 1000;
  }
  return std::nullopt;
}

/// Values near the present one, and small ones. SYNC is not produced faster than every 10 ms.
std::vector<std::uint64_t> other_numbers(const LiveEntry& entry, std::uint64_t present) {
  if (entry.index == sync_period) return {20'000, 10'000};
  if (entry.type->kind == DataClass::boolean) return {present == 0 ? 1U : 0U};
  if (entry.type->kind == DataClass::real) {
    if (entry.type->bits == 32) return {std::bit_cast<std::uint32_t>(1.0F), 0, std::bit_cast<std::uint32_t>(2.0F)};
    return {std::bit_cast<std::uint64_t>(1.0), 0, std::bit_cast<std::uint64_t>(2.0)};
  }
  return {present + 1, present - 1, 1, 2, 0, 254, 255, 10};
}

struct Written {
  Bytes bytes;
  std::string_view what;  ///< `DefaultValue`
};

void add_number(std::vector<Written>& values, Dut& dut, const LiveEntry& entry, std::uint64_t number,
                std::string_view what) {
  Bytes bytes = dut.bytes_of(entry.index, entry.sub_index, number);
  if (!is_within_limits(dut, *entry.entry, bytes)) return;
  values.push_back({std::move(bytes), what});
}

/// DefaultValue, and the limits that CiA 301 allows: each must be accepted.
std::vector<Written> stated_values(Dut& dut, const LiveEntry& entry) {
  std::vector<Written> values;
  if (const auto bytes = default_bytes(dut, *entry.entry); bytes && is_within_limits(dut, *entry.entry, *bytes)) {
    values.push_back({*bytes, "DefaultValue"});
  }
  if (!is_number(entry) || is_application(entry)) return values;  // case 4.6 writes the limits of the application
  for (const auto& [limit, what] :
       {std::pair{&entry.entry->low_limit, "LowLimit"}, {&entry.entry->high_limit, "HighLimit"}}) {
    if (!*limit || !is_allowed(entry, bits_of(dut, **limit))) continue;
    if (starts_sync(entry)) continue;
    add_number(values, dut, entry, bits_of(dut, **limit), what);
  }
  return values;
}

/// Other values than the present one: one of them must be accepted. In an application any value may be a command, so
/// that they are only written to a device in simulated time.
std::vector<Written> other_values(Dut& dut, const LiveEntry& entry, const Bytes& present) {
  std::vector<Written> values;
  constexpr std::string_view what = "another value";
  if (is_application(entry) && !dut.simulated()) return values;
  if (starts_sync(entry) && !dut.allowed(Permission::outputs)) return values;
  if (entry.type->kind == DataClass::string) {
    for (const std::uint8_t letter : {std::uint8_t{'a'}, std::uint8_t{'b'}}) {
      values.push_back(
          {entry.type->type == canopen::DataType::unicode_string ? Bytes{letter, 0} : Bytes{letter}, what});
    }
  } else if (is_cob_id(entry)) {
    add_number(values, dut, entry, other_cob_id(static_cast<std::uint32_t>(number_of(present))), what);
  } else if (entry.index == consumer_heartbeat) {
    if (const auto time = other_consumer_time(dut)) add_number(values, dut, entry, *time, what);
  } else if (!is_mapping(entry)) {
    for (const std::uint64_t number : other_numbers(entry, number_of(present))) {
      if (is_application(entry) || is_allowed(entry, number)) add_number(values, dut, entry, number, what);
    }
  }
  std::erase_if(values, [&](const Written& value) { return value.bytes == present; });
  return values;
}

// Writing

struct Refusal {
  std::string what;            ///< empty if the value was accepted
  bool denies_access = false;  ///< the device says that the entry is not writable, or has another size or none
};

/// Abort codes that contradict the AccessType or the DataType of the EDS, or a correct request. Others may depend on
/// the application.
bool denies_access(AbortCode code) {
  constexpr std::array codes = {AbortCode::unsupported_access,
                                AbortCode::read_only,
                                AbortCode::write_only,
                                AbortCode::no_object,
                                AbortCode::no_sub_index,
                                AbortCode::length_mismatch,
                                AbortCode::length_too_high,
                                AbortCode::length_too_low,
                                AbortCode::toggle_bit,
                                AbortCode::command_specifier,
                                AbortCode::block_size,
                                AbortCode::sequence_number,
                                AbortCode::crc,
                                AbortCode::not_mappable,
                                AbortCode::pdo_length,
                                AbortCode::sent_as_zero};
  return std::ranges::find(codes, code) != codes.end();
}

/// Writes one value, a parameter of the communication profile in the sequence of CiA 301.
Refusal write(Dut& dut, const LiveEntry& entry, const Bytes& bytes) {
  if (is_application(entry)) {
    const SdoOutcome outcome = is_readable(entry) ? dut.download(entry.index, entry.sub_index, bytes)
                                                  : dut.command(entry.index, entry.sub_index, bytes);
    if (outcome.done()) return {};
    return {outcome_text(outcome), outcome.end != SdoEnd::refused || denies_access(outcome.code)};
  }
  const ConfigurationResult result = dut.write_in_order({{entry, bytes, {}}});
  if (result.done()) return {};
  return {result.failures.empty() ? "no answer" : result.failures.front().what, true};
}

std::string written_text(const LiveEntry& entry, const Written& value, const std::string& what) {
  return fmt::format("{} {}: {}", value.what, value_of(entry, value.bytes), what);
}

/// Objects of CiA 301. Another parameter may have any meaning, and may accept few values.
constexpr std::array objects_of_cia301 = {IndexRange{0x1000, 0x1029}, IndexRange{0x1200, 0x12FF},
                                          IndexRange{0x1400, 0x1BFF}};

void report(WriteResults& results, const LiveEntry& entry, const Refusal& refusal, const std::string& text) {
  const bool fails = is_application(entry) ? refusal.denies_access : contains(objects_of_cia301, entry.index);
  fails ? results.fail(entry, text) : results.warn(entry, text);
}

void try_stated_values(Dut& dut, WriteResults& results, const LiveEntry& entry) {
  for (const Written& value : stated_values(dut, entry)) {
    if (const Refusal refusal = write(dut, entry, value.bytes); !refusal.what.empty()) {
      report(results, entry, refusal, written_text(entry, value, refusal.what));
      continue;
    }
    if (!is_readable(entry) || is_live(entry) || is_cob_id(entry) || entry.type->kind == DataClass::string) continue;
    const SdoOutcome after = dut.upload(entry.index, entry.sub_index);
    if (after.done() && after.bytes != value.bytes) {
      results.warn(entry, written_text(entry, value, "reads as " + value_of(entry, after.bytes)));
    }
  }
}

void try_other_values(Dut& dut, WriteResults& results, const LiveEntry& entry, const Bytes& present) {
  std::optional<Refusal> first;
  std::string text;
  for (const Written& value : other_values(dut, entry, present)) {
    Refusal refusal = write(dut, entry, value.bytes);
    if (refusal.what.empty()) return;
    if (first) continue;
    text = written_text(entry, value, refusal.what);
    first = std::move(refusal);
  }
  if (first) report(results, entry, *first, text);
}

void try_values(Dut& dut, WriteResults& results, const LiveEntry& entry) {
  const SdoOutcome before = is_readable(entry) ? dut.upload(entry.index, entry.sub_index) : SdoOutcome{};
  if (is_readable(entry) && !before.done()) return;  // cases 4.1 and 4.7
  if (is_readable(entry) && !is_within_limits(dut, *entry.entry, before.bytes)) {
    const std::string present = value_of(entry, before.bytes);
    return results.warn(entry, fmt::format("has {}, which is not within its limits: no value is written", present));
  }
  results.count();
  try_stated_values(dut, results, entry);
  try_other_values(dut, results, entry, before.bytes);
  if (is_readable(entry)) (void)write(dut, entry, before.bytes);
}

void write_values(Dut& dut, EntryFilter in_area, const std::string& none) {
  dut.enter(canopen::NmtState::pre_operational);
  WriteResults results{dut};
  for (const LiveEntry& entry : dut.entries()) {
    if (results.lost()) break;
    if (!in_area(entry) || !is_written(dut, entry) || is_mapping(entry) || is_one_of_many(dut, entry)) continue;
    try_values(dut, results, entry);
  }
  results.finish("each writable entry accepts its DefaultValue, its limits and another valid value", none);
}

void write_communication_values(Dut& dut) {
  write_values(dut, is_communication, "the EDS has no writable entry at 1000h to 1FFFh");
}
void write_application_values(Dut& dut) {
  write_values(dut, is_application, "the EDS has no writable entry at 2000h or above");
}

/// All parameters at once, as a configuration tool writes them.
void write_back_parameters(Dut& dut) {
  dut.enter(canopen::NmtState::pre_operational);
  WriteResults results{dut};
  std::vector<ConfigurationValue> values;
  for (const LiveEntry& entry : dut.entries()) {
    if (!is_communication(entry) || !is_written(dut, entry) || !is_readable(entry)) continue;
    SdoOutcome outcome = dut.upload(entry.index, entry.sub_index);
    if (outcome.end == SdoEnd::no_answer) break;
    if (!outcome.done()) continue;  // case 4.1
    results.count();
    values.push_back({entry, std::move(outcome.bytes), {}});
  }
  const ConfigurationResult result = dut.write_in_order(values);
  for (const ConfigurationFailure& failure : result.failures) results.fail(failure.entry, failure.what);
  results.finish("the device accepts the values that it has, in the sequence of CiA 301",
                 "the EDS has no writable entry at 1000h to 1FFFh");
}

constexpr CaseRow write_rows[] = {
    {"4.10", "The parameters of 1000h to 1FFFh accept the values that they have", "CiA 301, 7.4.5 and 7.5.2",
     Level::communication, Permission::none, write_back_parameters},
    {"4.11", "Each writable entry of 1000h to 1FFFh accepts its default value, its limits and another value",
     "CiA 301, 7.4.5 and 7.5.2", Level::communication, Permission::none, write_communication_values},
    {"4.12", "Each writable entry of 2000h and above accepts its default value, in simulated time also another one",
     "CiA 301, 7.4.5", Level::communication, Permission::application, write_application_values},
};

}  // namespace

std::span<const CaseRow> write_cases() { return write_rows; }

}  // namespace edsc::conform
