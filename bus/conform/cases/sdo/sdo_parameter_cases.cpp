/// SDO server and client parameters 1200h to 12FFh (CiA 301, 7.5.2.33 and 7.5.2.34).
#include <fmt/format.h>

#include <canopen/can/cob_id.hpp>
#include <map>
#include <utility>

#include "conform/case.hpp"
#include "conform/cases/sdo/sdo_entries.hpp"

namespace edsc::conform {
namespace {

using canopen::CobId;

constexpr std::uint16_t first_server = 0x1201, last_server = 0x127F;
constexpr std::uint16_t first_client = 0x1280, last_client = 0x12FF;

using ParameterValues = std::map<std::pair<std::uint16_t, std::uint8_t>, Bytes>;

/// A valid SDO server must not have a restricted CAN-ID.
void expect_usable(Dut& dut, const Entry& entry, std::uint64_t value) {
  constexpr std::uint32_t dynamic_bit = 0x4000'0000;
  if (entry.sub_index != 1 && entry.sub_index != 2) return;
  const CobId cob_id{static_cast<std::uint32_t>(value) & ~dynamic_bit};
  dut.expect(!cob_id.valid() || canopen::is_usable(cob_id.value()),
             "no restricted CAN-ID in " + label(entry.index, entry.sub_index), fmt::format("{:08X}h", value));
}

void read_sdo_parameter(Dut& dut, const Object& object, ParameterValues& values) {
  for (const Entry& entry : object.entries) {
    if (!canopen::readable(entry.access)) continue;
    const Bytes& value = values[{entry.index, entry.sub_index}] = dut.read(entry.index, entry.sub_index);
    if (object.index <= last_server) expect_usable(dut, entry, number_of(value));
  }
  if (!object.has_sub_indices()) return;
  if (const Entry* count = object.find(0); count != nullptr && count->type->type != canopen::DataType::unsigned8) {
    dut.fail_by_sheet("sub-index-0-type", label(object.index, 0) + " as UNSIGNED8 in the EDS",
                      std::string{count->type->name});
  }
  const std::uint64_t highest = dut.default_of(object.index, 0).value_or(object.highest_sub_index());
  dut.expect_equal(dut.read_number(object.index), highest, label(object.index, 0));
}

/// Reads all objects of the range: those of the EDS can be read, and the others do not exist.
ParameterValues read_sdo_parameters(Dut& dut, std::uint16_t first, std::uint16_t last) {
  ParameterValues values;
  for (std::uint16_t index = first; index <= last; ++index) {
    const Object* object = dut.sheet().find(index);
    if (object != nullptr) {
      read_sdo_parameter(dut, *object, values);
    } else {
      dut.expect_abort(dut.upload(index, 0), abort_rule::no_object, "read of " + label(index, 0));
    }
  }
  return values;
}

/// An SDO parameter of the range whose SDO is not valid, so that its values may change without an effect on the bus.
const Object* unused_parameter(Dut& dut, std::uint16_t first, std::uint16_t last, std::uint8_t sub_index) {
  for (const Object& object : dut.sheet().objects) {
    if (object.index < first || object.index > last || object.find(1) == nullptr) continue;
    const Entry* entry = object.find(sub_index);
    if (entry == nullptr || !canopen::writable(entry->access) || !canopen::readable(entry->access)) continue;
    if ((dut.read_number(object.index, 1) & CobId::invalid_bit) != 0) return &object;
  }
  return nullptr;
}

SdoOutcome save(Dut& dut) { return dut.command(store_parameters, 1, Bytes{'s', 'a', 'v', 'e'}); }

void read_servers(Dut& dut) { (void)read_sdo_parameters(dut, first_server, last_server); }

/// Reset communication restores the power-on values of the parameters.
void read_servers_after_reset(Dut& dut) {
  if (dut.sheet().find(first_server) == nullptr) dut.not_applicable("1201h does not exist in the EDS");
  dut.reset(canopen::NmtCommand::reset_communication);
  const auto before = read_sdo_parameters(dut, first_server, last_server);
  if (const Object* server = unused_parameter(dut, first_server, last_server, 1)) {
    constexpr std::uint32_t unused = CobId::invalid_bit | 0x6A0, other = CobId::invalid_bit | 0x6A1;
    // A device may refuse the CAN-ID and keep its value, which the reset then must not change.
    const std::uint64_t value = dut.read_number(server->index, 1) == unused ? other : unused;
    (void)dut.download(server->index, 1, value);
  }
  dut.reset(canopen::NmtCommand::reset_communication);
  for (const auto& [key, bytes] : read_sdo_parameters(dut, first_server, last_server)) {
    const std::string entry = label(key.first, key.second) + " ";
    const Bytes& wanted = before.at(key);
    dut.expect(bytes == wanted, entry + hex_bytes(wanted) + ", as after the last reset", entry + hex_bytes(bytes));
  }
}

/// A stored client parameter remains after reset communication. Objects that the EDS does not have do not exist.
void save_clients(Dut& dut) {
  (void)read_sdo_parameters(dut, first_client, last_client);
  constexpr std::uint8_t server_node = 3;
  const Object* client = unused_parameter(dut, first_client, last_client, server_node);
  if (client == nullptr) return;
  dut.need_writable(store_parameters, 1);
  constexpr std::uint64_t on_command = 1;
  if ((dut.read_number(store_parameters, 1) & on_command) == 0)
    dut.not_applicable("1010h:01 says that the device does not save on command");
  const std::uint64_t before = dut.read_number(client->index, server_node);
  const std::uint64_t changed = before == 1 ? 2 : 1;
  dut.write(client->index, server_node, changed);
  dut.expect_done(save(dut), "save to 1010h:01");
  dut.reset(canopen::NmtCommand::reset_communication);
  const std::uint64_t after = dut.read_number(client->index, server_node);
  dut.write(client->index, server_node, before);
  dut.expect_done(save(dut), "save with the former value to 1010h:01");
  dut.expect_equal(after, changed, label(client->index, server_node) + " after save and reset communication");
}

constexpr CaseRow sdo_parameter_rows[] = {
    {"2.28", "The objects 1201h to 127Fh are as in the EDS", "CiA 301, 7.5.2.33", Level::read, none, read_servers},
    {"2.29", "Reset communication restores the values of 1201h to 127Fh", "CiA 301, 7.5.2.33", Level::communication,
     none, read_servers_after_reset, Condition::none, "9.1"},
    {"2.30", "Reset communication keeps stored values of 1280h to 12FFh", "CiA 301, 7.5.2.34", Level::communication,
     Permission::store, save_clients, Condition::none, "8.2"},
};

}  // namespace

std::span<const CaseRow> sdo_parameter_cases() { return sdo_parameter_rows; }

}  // namespace edsc::conform
