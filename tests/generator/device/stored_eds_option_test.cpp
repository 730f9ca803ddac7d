/// The options `stored_eds` and `lss`, from the device to the input of the templates.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "backend/cpp/cpp_view.hpp"
#include "device/stored_eds.hpp"
#include "support/device_from_text.hpp"
#include "system/gzip.hpp"

namespace edsc {
namespace {

using nlohmann::ordered_json;

const std::string device_type = var("1000", "Device type", "7", "ro");
const std::string store_eds_object = var("1021", "Store EDS", "0xF", "ro");
const std::string store_format_object = var("1022", "Store format", "5", "ro", "DefaultValue=7\n");

Options keeping(StoredEds what) {
  Options options;
  options.stored_eds = what;
  return options;
}

struct Rendered : DeviceFromText {
  explicit Rendered(std::string text, Options given = {})
      : DeviceFromText{std::move(text), std::move(given)}, view(cpp_view(named(), options, diagnostics)) {}
  ordered_json view;
};

/// The message about options.
std::string complaint(const std::string& text, StoredEds what) {
  const DeviceFromText device{text, keeping(what)};
  for (const Diagnostic& diagnostic : device.diagnostics.all()) {
    if (diagnostic.rule.text() == "options") return diagnostic.message;
  }
  return "";
}

TEST(StoredEdsOption, LeavesTheDeviceAloneWhereItIsNotGiven) {
  const Rendered device{device_type + store_eds_object + store_format_object};
  EXPECT_EQ(device.entry(0x1022).default_value->bits, 7u);
  EXPECT_TRUE(device.view["stored_eds"].is_null());
}

TEST(StoredEdsOption, KeepsTheTextAndTellsItsFormat) {
  const Rendered device{device_type + store_eds_object + store_format_object, keeping(StoredEds::text)};
  EXPECT_EQ(device.entry(0x1022).default_value->bits, 0u);
  EXPECT_EQ(stored_eds(device.device, device.options), device.source.text());
  const std::string first = device.view["stored_eds"]["lines"][0];
  EXPECT_TRUE(first.starts_with("0x5B,0x31,0x30,0x30,0x30,0x5D,0x0A,")) << first;  // [1000]
}

TEST(StoredEdsOption, KeepsUtf8OfAnyEncoding) {
  const DeviceFromText device{device_type + store_eds_object + "; Ma\xDF\n", keeping(StoredEds::text)};
  EXPECT_TRUE(stored_eds(device.device, device.options).ends_with("; Ma\xC3\x9F\n"));
}

TEST(StoredEdsOption, KeepsAGzipFile) {
  const DeviceFromText device{device_type + store_eds_object + store_format_object, keeping(StoredEds::compressed)};
  EXPECT_EQ(device.entry(0x1022).default_value->bits, 0x80u);
  std::string text;
  EXPECT_EQ(gunzip(stored_eds(device.device, device.options), 100'000, text), "");
  EXPECT_EQ(text, device.source.text());
}

TEST(StoredEdsOption, NeedsADomainThatIsReadOnly) {
  const std::string no_domain = "option stored_eds: the EDS has no read-only DOMAIN 1021h";
  EXPECT_EQ(complaint(device_type, StoredEds::text), no_domain);
  EXPECT_EQ(complaint(device_type + var("1021", "Store EDS", "9", "ro"), StoredEds::text), no_domain);
  EXPECT_EQ(complaint(device_type + var("1021", "Store EDS", "0xF", "rw"), StoredEds::text), no_domain);
  EXPECT_EQ(complaint(device_type + store_eds_object, StoredEds::text), "");
}

TEST(StoredEdsOption, NeedsAFormatWhereItIsCompressed) {
  const std::string no_format = "option stored_eds: the EDS has no read-only integer 1022h for the format";
  EXPECT_EQ(complaint(device_type + store_eds_object, StoredEds::compressed), no_format);
  const std::string writable = var("1022", "Store format", "5", "rw");
  EXPECT_EQ(complaint(device_type + store_eds_object + writable, StoredEds::text), no_format);
  EXPECT_EQ(complaint(device_type + store_eds_object + store_format_object, StoredEds::compressed), "");
}

const std::string lss_device = "[DeviceInfo]\nLSS_Supported=1\nBaudRate_125=1\nBaudRate_500=1\nBaudRate_1000=0\n";

TEST(LssOption, TakesTheBitRatesOfTheDataSheet) {
  EXPECT_EQ(Rendered{lss_device + device_type}.view["lss"]["members"], ".bit_rates = 0x0014");
}

TEST(LssOption, IsMissingWhereNobodySpeaksOfLss) {
  EXPECT_TRUE(Rendered{device_type}.view["lss"].is_null());
  EXPECT_TRUE(Rendered{"[DeviceInfo]\nLSS_Supported=0\n" + device_type}.view["lss"].is_null());
}

TEST(LssOption, ComesBeforeTheDataSheet) {
  Options options;
  options.lss = LssSettings{std::uint16_t{0x0041}, {}};
  EXPECT_EQ((Rendered{lss_device + device_type, options}).view["lss"]["members"], ".bit_rates = 0x0041");
  EXPECT_EQ((Rendered{device_type, options}).view["lss"]["members"], ".bit_rates = 0x0041");
}

TEST(LssOption, NamesItsMembersInTheirOrder) {
  Options options;
  options.lss = LssSettings{std::nullopt,
                            {{"served_in_operational", true},
                             {"fastscan", false},
                             {"manufacturer_bit_timing", true},
                             {"unconfigurable", false}}};
  EXPECT_EQ((Rendered{lss_device + device_type, options}).view["lss"]["members"],
            ".bit_rates = 0x0014,\n      .manufacturer_bit_timing = true,\n      .unconfigurable = false,\n"
            "      .fastscan = false,\n      .served_in_operational = true");
}

}  // namespace
}  // namespace edsc
