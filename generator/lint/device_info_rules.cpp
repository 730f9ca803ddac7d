#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "device/bit_rates.hpp"
#include "diagnostics/quote.hpp"
#include "eds/number.hpp"
#include "lint/rule_groups.hpp"

namespace edsc {
namespace {

constexpr std::uint64_t max_granularity = 64;

struct Flag {
  std::string_view key;
  Field DeviceInfo::*field;
};

constexpr Flag flags[] = {
    {"SimpleBootUpMaster", &DeviceInfo::simple_boot_up_master},
    {"SimpleBootUpSlave", &DeviceInfo::simple_boot_up_slave},
    {"DynamicChannelsSupported", &DeviceInfo::dynamic_channels_supported},
    {"GroupMessaging", &DeviceInfo::group_messaging},
    {"LSS_Supported", &DeviceInfo::lss_supported},
};

void check_flag(const RuleContext& context, std::string_view key, const Field& field) {
  if (field.empty() || number_of(field).value_or(2) <= 1) return;
  context.report("device-info-flag", field.position, fmt::format("{} must be 0 or 1, not {}", key, quote(field.text)));
}

void check_flags(const RuleContext& context) {
  const DeviceInfo& info = context.sheet.device_info;
  for (const Flag& flag : flags) check_flag(context, flag.key, info.*flag.field);
  for (const DeviceInfo::BaudRate& rate : info.baud_rates) {
    check_flag(context, fmt::format("BaudRate_{}", rate.kbit_per_second), rate.field);
  }
}

void check_baud_rates(const RuleContext& context) {
  const DeviceInfo& info = context.sheet.device_info;
  bool any = false;
  for (const DeviceInfo::BaudRate& rate : info.baud_rates) {
    any = any || number_of(rate.field).value_or(0) != 0;
    if (is_bit_rate(rate.kbit_per_second)) continue;
    context.report("baud-rate-key", rate.field.position,
                   fmt::format("CiA 306 does not define a key BaudRate_{}", rate.kbit_per_second));
  }
  if (!any) context.report("baud-rates", info.position, "the device does not support any bit rate");
}

void check_granularity(const RuleContext& context) {
  const Field& field = context.sheet.device_info.granularity;
  if (field.empty() || number_of(field).value_or(max_granularity + 1) <= max_granularity) return;
  context.report("granularity", field.position, fmt::format("Granularity must be 0..64, not {}", quote(field.text)));
}

struct PdoCount {
  std::string_view key;
  Field DeviceInfo::*field;
  PdoDirection direction;
};

constexpr PdoCount pdo_counts[] = {
    {"NrOfRXPDO", &DeviceInfo::nr_of_rx_pdo, PdoDirection::receive},
    {"NrOfTXPDO", &DeviceInfo::nr_of_tx_pdo, PdoDirection::transmit},
};

/// With CompactPDO, most PDOs are not described individually.
void check_pdo_counts(const RuleContext& context) {
  const DeviceInfo& info = context.sheet.device_info;
  if (number_of(info.compact_pdo).value_or(0) != 0) return;
  for (const PdoCount& row : pdo_counts) {
    const Field& field = info.*row.field;
    const auto described =
        static_cast<std::uint64_t>(std::ranges::count(context.device.pdos, row.direction, &Pdo::direction));
    if (field.empty() || number_of(field) == described) continue;
    context.report("pdo-count", field.position,
                   fmt::format("{} is {}, but {} {} described", row.key, quote(field.text), described,
                               described == 1 ? "is" : "are"),
                   {}, "counts");
    context.diagnostics.offer_value("pdo-count", field.position, fmt::format("{}", described),
                                    fmt::format("number of the {}s that the file describes",
                                                row.direction == PdoDirection::receive ? "RPDO" : "TPDO"));
  }
}

struct IdentityNumber {
  AnyRule rule;
  std::string_view key;
  Field DeviceInfo::*field;
  std::uint8_t sub_index;
};

constexpr IdentityNumber identity_numbers[] = {
    {"vendor-number", "VendorNumber", &DeviceInfo::vendor_number, 1},
    {"product-number", "ProductNumber", &DeviceInfo::product_number, 2},
    {"revision-number", "RevisionNumber", &DeviceInfo::revision_number, 3},
};

void check_identity(const RuleContext& context) {
  for (const IdentityNumber& row : identity_numbers) {
    const Field& field = context.sheet.device_info.*row.field;
    const auto number = number_of(field);
    const Entry* entry = context.device.find(0x1018, row.sub_index);
    if (!number || entry == nullptr || !entry->default_value || entry->default_value->bits == *number) continue;
    context.report(
        row.rule, field.position,
        fmt::format("{} is 0x{:X}, but {} is 0x{:X}", row.key, *number, named(*entry), entry->default_value->bits),
        {{entry->default_value->position, "its default"}});
  }
}

/// LSS selects a device by vendor-ID, product code, revision number and serial number.
void check_lss(const RuleContext& context) {
  const Field& field = context.sheet.device_info.lss_supported;
  if (number_of(field).value_or(0) == 0) return;
  for (std::uint8_t sub_index = 1; sub_index <= 4; ++sub_index) {
    if (context.device.find(0x1018, sub_index) != nullptr) continue;
    context.report("lss-identity", field.position,
                   fmt::format("LSS requires all of 1018h, but {} is missing", entry_label(0x1018, sub_index)));
    return;
  }
}

void check_dynamic_channels(const RuleContext& context) {
  const Field& field = context.sheet.device_info.dynamic_channels_supported;
  if (number_of(field).value_or(0) == 0 || context.sheet.dynamic_channels.present) return;
  context.report("dynamic-channels", field.position,
                 "dynamic channels are supported, but section [DynamicChannels] is missing");
}

}  // namespace

void check_device_info(const RuleContext& context) {
  if (!context.sheet.device_info.present) {
    context.report("no-device-info", context.whole_file(), "missing section [DeviceInfo]");
    return;
  }
  check_flags(context);
  check_baud_rates(context);
  check_granularity(context);
  check_pdo_counts(context);
  check_identity(context);
  check_lss(context);
  check_dynamic_channels(context);
}

}  // namespace edsc
