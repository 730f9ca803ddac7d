/// Stored parameters (1010h, 1011h, 1020h; CiA 301, 7.5.2.13, 7.5.2.14 and 7.5.2.23) and restricted CAN-IDs (7.3.5).
#include <fmt/format.h>

#include <canopen/can/cob_id.hpp>
#include <canopen/can/cob_id_check.hpp>

#include "conform/cases/setup.hpp"
#include "conform/cases/storage_setup.hpp"

namespace edsc::conform {
namespace other_area {
namespace {

using canopen::CobId;
using canopen::NmtCommand;
using canopen::NmtState;

constexpr std::uint16_t store_parameters = 0x1010, restore_parameters = 0x1011, verify_configuration = 0x1020;
constexpr std::uint8_t date = 1, time = 2;

/// A parameter with a value that is neither the stored one nor the default value.
struct Changed {
  Parameter parameter;
  std::uint64_t before = 0, value = 0;
};

Changed change_parameter(Dut& dut) {
  const std::optional<Parameter> parameter = harmless_parameter(dut);
  if (!parameter)
    dut.not_applicable("the EDS has no parameter of 1000h to 1FFFh that can be changed without an effect");
  const std::uint64_t before = dut.read_number(parameter->index, parameter->sub_index);
  const std::uint64_t value = other_value(dut, *parameter);
  dut.write(parameter->index, parameter->sub_index, value);
  return {*parameter, before, value};
}

void expect_value(Dut& dut, const Changed& changed, std::uint64_t value, const std::string& when) {
  dut.expect_equal(dut.read_number(changed.parameter.index, changed.parameter.sub_index), value,
                   changed.parameter.name() + " " + when);
}

/// A wrong signature is refused, and nothing is stored.
template <std::uint8_t sub_index>
void wrong_save(Dut& dut) {
  with_storage(dut, sub_index, [&dut](const Storage& storage) {
    const Changed changed = change_parameter(dut);
    storage.expect_refused(store_parameters);
    storage.reset();
    expect_value(dut, changed, changed.before, "after a wrong signature and a reset (not stored)");
  });
}

/// After "save" the value remains after a reset, and after a power cycle if a stimulus can cause one.
template <std::uint8_t sub_index>
void save(Dut& dut) {
  with_storage(dut, sub_index, [&dut](const Storage& storage) {
    const Changed changed = change_parameter(dut);
    storage.save();
    storage.reset();
    expect_value(dut, changed, changed.value, "after \"save\" and a reset");
    const Dut::Mark since = dut.mark();
    if (!dut.stimuli().power_cycle()) return;
    dut.expect(dut.wait_for(dut.boot_up(), milliseconds{5000}, since).has_value(), "a boot-up message after power-on",
               "none");
    dut.pass_time(milliseconds{50});
    expect_value(dut, changed, changed.value, "after \"save\" and power-on");
  });
}

/// A wrong signature is refused, and the stored value remains.
template <std::uint8_t sub_index>
void wrong_load(Dut& dut) {
  need_command(dut, restore_parameters, sub_index);
  with_storage(dut, sub_index, [&dut](const Storage& storage) {
    const Changed changed = change_parameter(dut);
    storage.save();
    storage.expect_refused(restore_parameters);
    storage.reset();
    expect_value(dut, changed, changed.value, "after a wrong signature and a reset (still stored)");
  });
}

/// "load" restores the default values at the next reset.
template <std::uint8_t sub_index>
void load(Dut& dut) {
  need_command(dut, restore_parameters, sub_index);
  with_storage(dut, sub_index, [&dut](const Storage& storage) {
    const Changed changed = change_parameter(dut);
    const Parameter& parameter = changed.parameter;
    storage.save();
    storage.load();
    if (dut.read_number(parameter.index, parameter.sub_index) != changed.value) {
      dut.warn(parameter.name() + " changes at \"load\"; in CiA 301 the default values become valid at the next reset");
    }
    storage.reset();
    if (const auto by_default = dut.default_of(parameter.index, parameter.sub_index)) {
      return expect_value(dut, changed, *by_default, "after \"load\" and a reset (default value)");
    }
    const std::uint64_t read = dut.read_number(parameter.index, parameter.sub_index);
    dut.expect(read != changed.value, parameter.name() + " after \"load\" and a reset: not the stored value",
               fmt::format("{:X}h", read));
  });
}

/// 1020h is stored with the configuration, and set to 0 when the configuration changes.
void verify(Dut& dut) {
  dut.need_writable(verify_configuration, date);
  dut.need_writable(verify_configuration, time);
  with_storage(dut, Storage::all, [&dut](const Storage& storage) {
    const auto expect_both = [&dut](std::uint64_t first, std::uint64_t second, const std::string& when) {
      dut.expect_equal(dut.read_number(verify_configuration, date), first, "1020h:01 " + when);
      dut.expect_equal(dut.read_number(verify_configuration, time), second, "1020h:02 " + when);
    };
    constexpr std::uint64_t days = 15'000, milliseconds_of_day = 43'200'000;
    dut.write(verify_configuration, date, days);
    dut.write(verify_configuration, time, milliseconds_of_day);
    storage.save();
    storage.reset();
    expect_both(days, milliseconds_of_day, "after \"save\" and a reset");
    if (!harmless_parameter(dut)) return;
    (void)change_parameter(dut);
    expect_both(0, 0, "after a parameter has changed");
  });
}

/// The first and the last CAN-ID of each range of CiA 301, 7.3.5, table 41.
constexpr std::uint32_t restricted[] = {0x000, 0x001, 0x07F, 0x101, 0x180, 0x581, 0x5FF, 0x601,
                                        0x67F, 0x6E0, 0x6FF, 0x701, 0x77F, 0x780, 0x7FF};

/// The flags that disable the COB-ID, so that its CAN-ID may change, and those that enable it.
struct Flags {
  std::uint32_t off_set = 0, off_cleared = 0, on_set = 0;
};

Flags flags_of(std::uint16_t index) {
  constexpr std::uint32_t consumes_time = 0x8000'0000;
  switch (index) {
    case 0x1005: return {0, CobId::no_rtr_bit, 0};
    case 0x1012: return {0, consumes_time | CobId::no_rtr_bit, consumes_time};
    default: return {CobId::invalid_bit, 0, 0};
  }
}

void expect_restricted_refused(Dut& dut, const Entry& entry) {
  const std::uint16_t index = entry.index;
  const std::uint8_t sub_index = entry.sub_index;
  const Flags flags = flags_of(index);
  const auto present = static_cast<std::uint32_t>(dut.read_number(index, sub_index));
  const std::uint32_t off = (present | flags.off_set) & ~flags.off_cleared;
  if (off != present) dut.write(index, sub_index, off);
  const std::uint64_t before = dut.read_number(index, sub_index);  // a device may keep some bits
  const std::uint32_t kept = present & CobId::no_rtr_bit & ~flags.off_cleared;
  for (const std::uint32_t can_id : restricted) {
    const SdoOutcome outcome = dut.download(index, sub_index, kept | flags.on_set | can_id);
    dut.expect_abort(outcome, abort_rule::value,
                     fmt::format("the restricted CAN-ID {:03X}h written to {}", can_id, label(index, sub_index)));
  }
  dut.expect_equal(dut.read_number(index, sub_index), before, label(index, sub_index) + " afterwards");
}

void restricted_can_ids(Dut& dut) {
  if (dut.has(0x1005)) stop_sync(dut);
  bool any = false;
  for (const LiveEntry& live : dut.entries()) {
    const Entry& entry = *live.entry;
    const bool holds_cob_id = canopen::find_cob_id_entries(entry.index, entry.sub_index).has_value();
    if (!holds_cob_id || !canopen::writable(entry.access) || !canopen::readable(entry.access)) continue;
    const auto present = static_cast<std::uint32_t>(dut.read_number(entry.index, entry.sub_index));
    if (!canopen::is_legal({entry.index, entry.sub_index, present})) {
      dut.warn(fmt::format("{} is {:08X}h, which could not be put back; not tested",
                           label(entry.index, entry.sub_index), present));
      continue;
    }
    any = true;
    expect_restricted_refused(dut, entry);
  }
  if (!any) dut.not_applicable("the EDS has no writable COB-ID that can be tested");
}

constexpr CaseRow rows[] = {
    {"8.1", "1010h:01 refuses a signature other than \"save\" and stores nothing", "CiA 301, 7.5.2.13",
     Level::communication, Permission::store, wrong_save<Storage::all>},
    {"8.2", "\"save\" to 1010h:01 stores all parameters", "CiA 301, 7.5.2.13", Level::communication, Permission::store,
     save<Storage::all>},
    {"8.3", "1011h:01 refuses a signature other than \"load\" and keeps the stored values", "CiA 301, 7.5.2.14",
     Level::communication, Permission::store, wrong_load<Storage::all>},
    {"8.4", "\"load\" to 1011h:01 restores the default values at the next reset", "CiA 301, 7.5.2.14",
     Level::communication, Permission::store, load<Storage::all>},
    {"8.5", "1010h:02 refuses a signature other than \"save\" and stores nothing", "CiA 301, 7.5.2.13",
     Level::communication, Permission::store, wrong_save<Storage::communication>},
    {"8.6", "\"save\" to 1010h:02 stores the communication parameters", "CiA 301, 7.5.2.13", Level::communication,
     Permission::store, save<Storage::communication>},
    {"8.7", "1011h:02 refuses a signature other than \"load\" and keeps the stored values", "CiA 301, 7.5.2.14",
     Level::communication, Permission::store, wrong_load<Storage::communication>},
    {"8.8", "\"load\" to 1011h:02 restores the default values at the next reset communication", "CiA 301, 7.5.2.14",
     Level::communication, Permission::store, load<Storage::communication>},
    {"8.9", "1020h is stored, and set to 0 when a parameter changes", "CiA 301, 7.5.2.23", Level::communication,
     Permission::store, verify},
    {"8.10", "COB-IDs refuse the restricted CAN-IDs", "CiA 301, 7.3.5, table 41", Level::communication,
     Permission::none, restricted_can_ids},
};

}  // namespace
}  // namespace other_area

std::span<const CaseRow> other_cases() { return other_area::rows; }

}  // namespace edsc::conform
