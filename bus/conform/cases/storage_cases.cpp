/// Area 8: stored parameters (1010h, 1011h, 1020h; CiA 301, 7.5.2.13, 7.5.2.14 and 7.5.2.23), and the table of the
/// area.
#include <fmt/format.h>

#include "conform/cases/restricted_can_ids.hpp"
#include "conform/cases/shared/setup.hpp"
#include "conform/cases/shared/storage_setup.hpp"

namespace edsc::conform {
namespace {

using canopen::NmtCommand;
using canopen::NmtState;

constexpr std::uint8_t configuration_date = 1, configuration_time = 2;

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

/// A wrong signature is refused, and nothing is stored. Reset node shows it also on a device whose reset communication
/// does not load the stored values: case 9.1.
void wrong_save(Dut& dut, std::uint8_t sub_index) {
  with_storage(dut, sub_index, [&dut](const Storage& storage) {
    const Changed changed = change_parameter(dut);
    storage.expect_refused(store_parameters);
    dut.reset(NmtCommand::reset_node);
    expect_value(dut, changed, changed.before, "after a wrong signature and a reset (not stored)");
  });
}

/// After "save" the value remains after a reset, and after a power cycle if a stimulus can cause one.
void save(Dut& dut, std::uint8_t sub_index) {
  with_storage(dut, sub_index, [&dut](const Storage& storage) {
    const Changed changed = change_parameter(dut);
    storage.save();
    dut.reset(NmtCommand::reset_node);
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
void wrong_load(Dut& dut, std::uint8_t sub_index) {
  need_command(dut, restore_parameters, sub_index);
  with_storage(dut, sub_index, [&dut](const Storage& storage) {
    const Changed changed = change_parameter(dut);
    storage.save();
    storage.expect_refused(restore_parameters);
    dut.reset(NmtCommand::reset_node);
    expect_value(dut, changed, changed.value, "after a wrong signature and a reset (still stored)");
  });
}

/// "load" restores the default values at the next reset.
void load(Dut& dut, std::uint8_t sub_index) {
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

// ---- power cuts ----

void expect_started(Dut& dut, Dut::Mark since) {
  const auto started = dut.wait_for(dut.boot_up(), milliseconds{5000}, since);
  dut.expect(started.has_value(), "a boot-up message after power-on", "none");
  dut.pass_time(milliseconds{50});
}

/// What is confirmed is stored: the power cut follows without a reset before it.
void power_cut_after_save(Dut& dut) {
  with_storage(dut, Storage::all, [&dut](const Storage& storage) {
    const Changed changed = change_parameter(dut);
    storage.save();
    const Dut::Mark since = dut.mark();
    if (!dut.stimuli().power_cycle()) dut.inconclusive(Condition::stimulus, "needs a stimulus that cuts the power");
    expect_started(dut, since);
    expect_value(dut, changed, changed.value, "after \"save\" and a power cut");
  });
}

/// Parameters that have no effect on each other.
std::vector<Changed> change_parameters(Dut& dut) {
  constexpr Parameter candidates[] = {{0x1017, 0}, {0x1015, 0}, {0x1007, 0}, {0x1800, 5}, {0x1801, 5}};
  std::vector<Changed> all;
  for (const Parameter& parameter : candidates) {
    if (!dut.is_writable(parameter.index, parameter.sub_index)) continue;
    if (!dut.is_readable(parameter.index, parameter.sub_index)) continue;
    const std::uint64_t before = dut.read_number(parameter.index, parameter.sub_index);
    const std::uint64_t value = other_value(dut, parameter);
    if (value != before && dut.download(parameter.index, parameter.sub_index, value).done()) {
      all.push_back({parameter, before, value});
    }
  }
  if (all.empty()) dut.not_applicable("the EDS has no parameter of 1000h to 1FFFh that can be changed");
  return all;
}

/// A power cut before "save" is confirmed leaves the former values or the new ones, not some of each.
void power_cut_during_save(Dut& dut) {
  with_storage(dut, Storage::all, [&dut](const Storage&) {
    const std::vector<Changed> all = change_parameters(dut);
    const Dut::Mark since = dut.mark();
    namespace sdo = canopen::sdo;
    sdo::Data save{0x23, store_parameters & 0xFF, store_parameters >> 8, Storage::all, 's', 'a', 'v', 'e'};
    dut.request(save);
    if (!dut.stimuli().power_cycle()) dut.inconclusive(Condition::stimulus, "needs a stimulus that cuts the power");
    expect_started(dut, since);
    std::string former, present;
    for (const Changed& changed : all) {
      const std::uint64_t read = dut.read_number(changed.parameter.index, changed.parameter.sub_index);
      dut.expect(
          read == changed.before || read == changed.value,
          fmt::format("{} after a power cut: {:X}h or {:X}h", changed.parameter.name(), changed.before, changed.value),
          fmt::format("{:X}h", read));
      std::string& list = read == changed.before ? former : present;
      list += (list.empty() ? "" : ", ") + changed.parameter.name();
    }
    dut.expect(former.empty() || present.empty(), "all values from before \"save\", or all new ones, after a power cut",
               fmt::format("from before: {}; new: {}", former, present));
  });
}

/// 1020h is stored with the configuration, and set to 0 when the configuration changes.
void verify(Dut& dut) {
  dut.need_writable(verify_configuration, configuration_date);
  dut.need_writable(verify_configuration, configuration_time);
  with_storage(dut, Storage::all, [&dut](const Storage& storage) {
    const auto expect_both = [&dut](std::uint64_t first, std::uint64_t second, const std::string& when) {
      dut.expect_equal(dut.read_number(verify_configuration, configuration_date), first, "1020h:01 " + when);
      dut.expect_equal(dut.read_number(verify_configuration, configuration_time), second, "1020h:02 " + when);
    };
    constexpr std::uint64_t days = 15'000, milliseconds_of_day = 43'200'000;
    dut.write(verify_configuration, configuration_date, days);
    dut.write(verify_configuration, configuration_time, milliseconds_of_day);
    storage.save();
    storage.reset();
    expect_both(days, milliseconds_of_day, "after \"save\" and a reset");
    if (!harmless_parameter(dut)) return;
    (void)change_parameter(dut);
    expect_both(0, 0, "after a parameter has changed");
  });
}

constexpr CaseRow storage_rows[] = {
    {"8.1", "1010h:01 refuses a signature other than \"save\" and stores nothing", "CiA 301, 7.5.2.13",
     Level::communication, Permission::store, with<wrong_save, Storage::all>, Condition::none, "9.1"},
    {"8.2", "\"save\" to 1010h:01 stores all parameters", "CiA 301, 7.5.2.13", Level::communication, Permission::store,
     with<save, Storage::all>, Condition::none, "9.1"},
    {"8.3", "1011h:01 refuses a signature other than \"load\" and keeps the stored values", "CiA 301, 7.5.2.14",
     Level::communication, Permission::store, with<wrong_load, Storage::all>, Condition::none, "9.1"},
    {"8.4", "\"load\" to 1011h:01 restores the default values at the next reset", "CiA 301, 7.5.2.14",
     Level::communication, Permission::store, with<load, Storage::all>, Condition::none, "9.1"},
    {"8.5", "1010h:02 refuses a signature other than \"save\" and stores nothing", "CiA 301, 7.5.2.13",
     Level::communication, Permission::store, with<wrong_save, Storage::communication>, Condition::none, "9.1"},
    {"8.6", "\"save\" to 1010h:02 stores the communication parameters", "CiA 301, 7.5.2.13", Level::communication,
     Permission::store, with<save, Storage::communication>, Condition::none, "9.1"},
    {"8.7", "1011h:02 refuses a signature other than \"load\" and keeps the stored values", "CiA 301, 7.5.2.14",
     Level::communication, Permission::store, with<wrong_load, Storage::communication>, Condition::none, "9.1"},
    {"8.8", "\"load\" to 1011h:02 restores the default values at the next reset communication", "CiA 301, 7.5.2.14",
     Level::communication, Permission::store, with<load, Storage::communication>, Condition::none, "9.1"},
    {"8.9", "1020h is stored, and set to 0 when a parameter changes", "CiA 301, 7.5.2.23", Level::communication,
     Permission::store, verify, Condition::none, "8.2"},
    {"8.10", "COB-IDs refuse the restricted CAN-IDs", "CiA 301, 7.3.5, table 41", Level::communication,
     Permission::none, restricted_can_ids},
    {"8.101", "Values that \"save\" has confirmed remain after a power cut", "CiA 301, 7.5.2.13", Level::communication,
     Permission::store, power_cut_after_save, Condition::stimulus, "8.2"},
    {"8.102", "A power cut during \"save\" leaves the former values or the new ones", "CiA 301, 7.5.2.13",
     Level::communication, Permission::store, power_cut_during_save, Condition::stimulus, "8.2"},
};

}  // namespace

std::span<const CaseRow> storage_cases() { return storage_rows; }

}  // namespace edsc::conform
