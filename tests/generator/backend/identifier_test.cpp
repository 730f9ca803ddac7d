#include "backend/cpp/identifier.hpp"

#include <gtest/gtest.h>

#include <string>

#include "backend/identifiers.hpp"
#include "text/snake_case.hpp"

namespace edsc {
namespace {

struct NameRow {
  const char* parameter_name;
  const char* identifier;
};

TEST(Identifier, IsTheParameterNameInSnakeCase) {
  for (const NameRow& row : {
           NameRow{"Position actual value", "position_actual_value"},
           NameRow{"COB-ID SYNC", "cob_id_sync"},
           NameRow{"Statusword", "statusword"},
           NameRow{"NrOfRxPDO", "nr_of_rx_pdo"},
           NameRow{"RxPDOMapping", "rx_pdo_mapping"},
           NameRow{"COB-IDs used", "cob_ids_used"},
           NameRow{"number of PDOs", "number_of_pdos"},
           NameRow{"Drive.Axis[1].Speed (rpm)", "drive_axis_1_speed_rpm"},
           NameRow{"  blanks   between  ", "blanks_between"},
           NameRow{"CANopen version", "canopen_version"},
           NameRow{"CANopenVersion", "canopen_version"},
           NameRow{"CANOpen stack", "canopen_stack"},
           NameRow{"CanOpenFD", "canopen_fd"},
           NameRow{"MyCANopenNode", "my_canopen_node"},
           NameRow{"CANOPEN", "canopen"},
           NameRow{"CiA402", "cia402"},
           NameRow{"CiA 402 mode", "cia_402_mode"},
           NameRow{"CiADSPMode", "cia_dsp_mode"},
           NameRow{"CiAo", "ci_ao"},
           NameRow{"EtherCAT state", "ethercat_state"},
           NameRow{"DxWiFi", "dx_wifi"},
           NameRow{"RPDO1", "rpdo1"},
           NameRow{"RPDO1COBID", "rpdo1cobid"},
           NameRow{"TPDOMapping", "tpdo_mapping"},
           NameRow{"NMT startup", "nmt_startup"},
           NameRow{"NMTStartup", "nmt_startup"},
           NameRow{"EMCYHistory", "emcy_history"},
           NameRow{"SDOs", "sdos"},
           NameRow{"I2C address", "i2c_address"},
           NameRow{"RS485 baud", "rs485_baud"},
           NameRow{"Voltage (mV)", "voltage_mv"},
           NameRow{"Level_dB", "level_db"},
           NameRow{"24mA output", "n_24ma_output"},
           NameRow{"Limit in kHz", "limit_in_khz"},
           NameRow{"EnergykWh", "energyk_wh"},
           NameRow{"Clock MHz", "clock_mhz"},
           NameRow{"pGain", "p_gain"},
           NameRow{"xY1", "xy1"},
           NameRow{"already_snake_case", "already_snake_case"},
           NameRow{"__leading and trailing__", "leading_and_trailing"},
       }) {
    EXPECT_EQ(to_snake_case(row.parameter_name), row.identifier) << row.parameter_name;
  }
}

TEST(Identifier, ThatBeginsWithADigitGetsALetterBefore) {
  EXPECT_EQ(to_snake_case("24V supply"), "n_24v_supply");
  EXPECT_EQ(to_snake_case("1"), "n_1");
}

TEST(Identifier, WritesLettersBeyondAsciiOutWhereThatIsUsual) {
  EXPECT_EQ(to_snake_case("Gerätezustand"), "geraetezustand");
  EXPECT_EQ(to_snake_case("Größe"), "groesse");
  EXPECT_EQ(to_snake_case("Temperature [°C]"), "temperature_deg_c");
  EXPECT_EQ(to_snake_case("time in µs"), "time_in_us");
  EXPECT_EQ(to_snake_case("R = 5 Ω"), "r_5_ohm");
  EXPECT_EQ(to_snake_case("vitesse désirée"), "vitesse_desiree");
}

TEST(Identifier, IsEmptyWhenNoLetterAndNoDigitIsLeft) {
  for (const char* name : {"", " ", "---", "_", "*/", "速度", "\xF0\x9F\x9A\x80"}) {
    EXPECT_EQ(to_snake_case(name), "") << name;
  }
}

TEST(Identifier, MayBeAWordOfALanguage) {
  EXPECT_EQ(to_snake_case("SWITCH"), "switch");
  EXPECT_EQ(to_snake_case("Float_"), "float");
}

TEST(CppIdentifier, IsNoWordOfTheLanguage) {
  EXPECT_EQ(to_cpp_identifier("Default"), "default_");
  EXPECT_EQ(to_cpp_identifier("SWITCH"), "switch_");
  EXPECT_EQ(to_cpp_identifier("xor eq"), "xor_eq_");
  EXPECT_EQ(to_cpp_identifier("static cast"), "static_cast_");
  EXPECT_EQ(to_cpp_identifier("Statusword"), "statusword");
}

TEST(CppIdentifier, IsNoUsualMacroAndNoMemberOfAGeneratedObject) {
  for (const char* name : {"errno", "linux", "unix", "stdin", "assert", "offsetof", "type", "index", "sub_index",
                           "name", "bits", "access", "mappable", "low_limit", "high_limit", "od", "std", "canopen"}) {
    EXPECT_EQ(to_cpp_identifier(name), std::string{name} + "_");
  }
}

TEST(Identifier, SurvivesTextThatEndsInsideACodePoint) {
  EXPECT_EQ(to_snake_case("speed \xC3"), "speed");
  EXPECT_EQ(to_snake_case("\xE2\x84"), "");
}

TEST(CamelCase, JoinsTheWords) {
  EXPECT_EQ(to_camel_case("tpdo_communication_parameter"), "TpdoCommunicationParameter");
  EXPECT_EQ(to_camel_case("n_24v_supply"), "N24vSupply");
  EXPECT_EQ(to_camel_case("default_"), "Default");
  EXPECT_EQ(to_camel_case(""), "");
}

TEST(IdentifierScope, GivesEachNameOnce) {
  IdentifierScope scope;
  EXPECT_EQ(scope.take("speed", "2000"), "speed");
  EXPECT_EQ(scope.take("speed", "2001"), "speed_2001");
  EXPECT_EQ(scope.take("speed", "2001"), "speed_2001_2");
  EXPECT_EQ(scope.take("speed", "2001"), "speed_2001_3");
  EXPECT_EQ(scope.take("speed_2001", "2002"), "speed_2001_2002");
}

TEST(IdentifierScope, PutsOneUnderscoreBeforeTheSuffix) {
  IdentifierScope scope;
  EXPECT_EQ(scope.take("default_", "2000"), "default_");
  EXPECT_EQ(scope.take("default_", "2001"), "default_2001");
}

}  // namespace
}  // namespace edsc
