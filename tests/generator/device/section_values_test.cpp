/// The values of a section that `edsc dump` has from the rows of its keys.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <variant>
#include <vector>

#include "backend/json/information_view.hpp"
#include "device/resolve_information.hpp"
#include "support/device_from_text.hpp"

namespace edsc {
namespace {

struct GatewaySection {
  Field name, networks, first_port, unused;
};

constexpr KeyRow<GatewaySection> gateway_keys[] = {
    {{"GatewayName"}, &GatewaySection::name},
    {{"NrOfNetworks", ValueKind::number}, &GatewaySection::networks},
    {{"FirstPort", ValueKind::number}, &GatewaySection::first_port},
    {{"Port", ValueKind::number, 1, Numbering::decimal}, nullptr},
    {{"Unused"}, &GatewaySection::unused},
};

Field present(std::string_view text) { return {text, {}, true}; }

TEST(SectionValues, AreThosePresentInTheOrderOfTheRows) {
  GatewaySection section;
  section.name = present("North; hall 2");
  section.networks = present("0x10 ; networks");
  Diagnostics diagnostics;
  const std::vector<SectionValue> values = section_values(gateway_keys, section, "device-info", diagnostics);
  ASSERT_EQ(values.size(), 2U);
  EXPECT_EQ(values[0].key, "GatewayName");
  EXPECT_EQ(std::get<std::string>(values[0].value), "North; hall 2");
  EXPECT_EQ(values[1].key, "NrOfNetworks");
  EXPECT_EQ(std::get<std::uint32_t>(values[1].value), 16U);
  EXPECT_EQ(rules_of(diagnostics), std::vector<std::string>{});
}

TEST(SectionValues, LeaveOutWhatIsNotANumber) {
  GatewaySection section;
  section.networks = present("many");
  section.first_port = present("0");
  Diagnostics diagnostics;
  const std::vector<SectionValue> values = section_values(gateway_keys, section, "device-info", diagnostics);
  ASSERT_EQ(values.size(), 1U);
  EXPECT_EQ(values[0].key, "FirstPort");
  EXPECT_EQ(rules_of(diagnostics), std::vector<std::string>{"device-info"});
}

TEST(SectionValues, AreInTheViewByTitleAndKey) {
  Information information;
  information.sections = {{"GatewayInfo", {{"GatewayName", std::string{"North"}}, {"NrOfNetworks", std::uint32_t{2}}}}};
  nlohmann::ordered_json view;
  add_information(information, view);
  EXPECT_EQ(view["sections"],
            nlohmann::ordered_json::parse(R"({"GatewayInfo": {"GatewayName": "North", "NrOfNetworks": 2}})"));
}

TEST(SectionValues, AreNotInTheViewWithoutSuchASection) {
  nlohmann::ordered_json view;
  add_information({}, view);
  EXPECT_FALSE(view.contains("sections"));
}

}  // namespace
}  // namespace edsc
