#include "backend/dbc/dbc.hpp"

#include <gtest/gtest.h>

#include <string>

#include "backend/dbc/dbc_name.hpp"
#include "support/device_from_text.hpp"
#include "support/read_options.hpp"

namespace edsc {
namespace {

/// A communication parameter with sub-indices 1, 2 and 5, and a mapping parameter with these entries.
std::string pdo(const std::string& index, const std::string& mapping_index, const std::string& cob_id,
                const std::vector<std::string>& mapped, const std::string& type = "255",
                const std::string& timer = "0") {
  std::string text = group(index, "PDO communication parameter", "0x9", 4) +
                     sub(index, 0, "Highest sub-index", "0x5", "DefaultValue=5\n") +
                     sub(index, 1, "COB-ID", "0x7", "DefaultValue=" + cob_id + "\n") +
                     sub(index, 2, "Transmission type", "0x5", "DefaultValue=" + type + "\n") +
                     sub(index, 5, "Event timer", "0x6", "DefaultValue=" + timer + "\n");
  text += group(mapping_index, "PDO mapping parameter", "0x9", static_cast<int>(mapped.size()) + 1) +
          sub(mapping_index, 0, "Number of entries", "0x5", "DefaultValue=" + std::to_string(mapped.size()) + "\n");
  int number = 0;
  for (const std::string& entry : mapped) {
    text += sub(mapping_index, ++number, "Entry", "0x7", "DefaultValue=" + entry + "\n");
  }
  return text;
}

std::string objects() {
  const std::string mapped = "PDOMapping=1\n";
  return "[DeviceInfo]\nGranularity=1\n[DummyUsage]\nDummy0005=1\n" + var("6040", "Controlword", "0x6", "rww", mapped) +
         var("6041", "Statusword", "0x6", "ro", mapped + "LowLimit=1\nHighLimit=0x7FFF\n") +
         var("6064", "Position actual value", "0x4", "ro", mapped + "Factor=0.5\nUnit=\xC2\xB0\n") +
         var("2001", "Torque", "0x8", "ro", mapped + "Unit=Nm\n") + var("2002", "Ready", "0x1", "ro", mapped) +
         var("2003", "Clock", "0xC", "ro", mapped) +
         group("2010", "Axis values of the left hand side drive", "0x9", 3) +
         sub("2010", 0, "Highest sub-index", "0x5", "DefaultValue=2\n") + sub("2010", 1, "Speed", "0x2", mapped) +
         sub("2010", 2, "Slip", "0x2", mapped);
}

bool has_line(const Dbc& dbc, const std::string& line) {
  return ("\n" + dbc.text).find("\n" + line + "\n") != std::string::npos;
}

Dbc dbc_from(const std::string& pdos, const std::string& name = "drive") {
  const DeviceFromText read{objects() + pdos, {}, {.name = name, .node_id = 5}};
  return dbc_of(read.device, read.names.identifiers());
}

TEST(Dbc, HasATpdoWithTheTypesOfItsObjects) {
  const Dbc dbc = dbc_from(
      pdo("1800", "1A00", "$NODEID+0x180", {"0x60410010", "0x60640020", "0x20100108", "0x20020001"}, "254", "100"));
  EXPECT_TRUE(has_line(dbc, "BU_: drive")) << dbc.text;
  EXPECT_TRUE(has_line(dbc, "BO_ 389 drive_tpdo_1: 8 drive"));
  EXPECT_TRUE(has_line(dbc, " SG_ statusword : 0|16@1+ (1,0) [1|32767] \"\" Vector__XXX"));
  EXPECT_TRUE(
      has_line(dbc, " SG_ position_actual_value : 16|32@1- (0.5,0) [-1073741824|1073741823.5] \"\xB0\" Vector__XXX"));
  EXPECT_TRUE(has_line(dbc, " SG_ ready : 56|1@1+ (1,0) [0|1] \"\" Vector__XXX"));
  EXPECT_TRUE(has_line(dbc, "CM_ BO_ 389 \"TPDO 1, transmission type 254\";"));
  EXPECT_TRUE(has_line(dbc, "CM_ SG_ 389 statusword \"6041h:00 Statusword\";"));
  EXPECT_TRUE(has_line(dbc, "BA_ \"GenMsgCycleTime\" BO_ 389 100;"));
  EXPECT_TRUE(dbc.notes.empty());
}

/// A device with these sections and a TPDO that maps these entries; `meaning` is the option.
Dbc dbc_with_meaning(const std::string& sections, const std::vector<std::string>& mapped, const std::string& meaning) {
  const ReadOptions options(R"({ "meaning": )" + meaning + " }");
  EXPECT_TRUE(options.diagnostics.all().empty()) << meaning;
  const DeviceFromText read{
      sections + pdo("1800", "1A00", "$NODEID+0x180", mapped), options.options, {.name = "drive", .node_id = 5}};
  return dbc_of(read.device, read.names.identifiers());
}

TEST(Dbc, HasScaleOffsetAndUnitOfAQuantity) {
  const Dbc dbc = dbc_with_meaning(var("2000", "Temperature", "0x5", "ro", "PDOMapping=1\n"), {"0x20000008"},
                                   R"({"2000h": {"unit": "degC", "scale": "1/2", "offset": -40}})");
  EXPECT_TRUE(has_line(dbc, " SG_ temperature : 0|8@1+ (0.5,-40) [-40|87.5] \"\xB0\x43\" Vector__XXX")) << dbc.text;
}

TEST(Dbc, SwapsTheLimitsOfANegativeScale) {
  const Dbc dbc = dbc_with_meaning(var("2000", "Level", "0x5", "ro", "PDOMapping=1\n"), {"0x20000008"},
                                   R"({"2000h": {"unit": "mm", "scale": -1}})");
  EXPECT_TRUE(has_line(dbc, " SG_ level : 0|8@1+ (-1,0) [-255|0] \"mm\" Vector__XXX")) << dbc.text;
}

TEST(Dbc, SpellsAUnitInAsciiThatTheCodePageDoesNotHave) {
  const Dbc dbc = dbc_with_meaning(var("2000", "Resistance", "0x5", "ro", "PDOMapping=1\n"), {"0x20000008"},
                                   R"({"2000h": {"unit": "ohm"}})");
  EXPECT_TRUE(has_line(dbc, " SG_ resistance : 0|8@1+ (1,0) [0|255] \"ohm\" Vector__XXX")) << dbc.text;
}

TEST(Dbc, HasNamesOfValues) {
  const Dbc dbc = dbc_with_meaning(var("2000", "Mode", "0x2", "ro", "PDOMapping=1\n"), {"0x20000008"},
                                   R"({"2000h": {"values": {"-1": "homing", "1": "profile_position"}}})");
  EXPECT_TRUE(has_line(dbc, "VAL_ 389 mode -1 \"homing\" 1 \"profile_position\" ;")) << dbc.text;
}

TEST(Dbc, HasASignalForEachFieldAndForBitsWithoutOne) {
  const Dbc dbc = dbc_with_meaning(
      var("2000", "First", "0x5", "ro", "PDOMapping=1\n") + var("2001", "Word", "0x6", "ro", "PDOMapping=1\n"),
      {"0x20000008", "0x20010010"},
      R"({"2001h": {"bits": {"0": {"name": "open", "text": "the door"}, "1..2": {"name": "zone", "values": {"3": "hall"}},
          "4": null, "8..15": {"name": "heat", "unit": "K", "signed": true}}}})");
  EXPECT_TRUE(has_line(dbc, " SG_ word_open : 8|1@1+ (1,0) [0|1] \"\" Vector__XXX")) << dbc.text;
  EXPECT_TRUE(has_line(dbc, "CM_ SG_ 389 word_open \"2001h:00 Word, bit 0: the door\";"));
  EXPECT_TRUE(has_line(dbc, " SG_ word_zone : 9|2@1+ (1,0) [0|3] \"\" Vector__XXX"));
  EXPECT_TRUE(has_line(dbc, "VAL_ 389 word_zone 3 \"hall\" ;"));
  EXPECT_TRUE(has_line(dbc, " SG_ word_bit_3 : 11|1@1+ (1,0) [0|1] \"\" Vector__XXX"));
  EXPECT_TRUE(has_line(dbc, " SG_ word_bits_5_to_7 : 13|3@1+ (1,0) [0|7] \"\" Vector__XXX"));
  EXPECT_TRUE(has_line(dbc, " SG_ word_heat : 16|8@1- (1,0) [-128|127] \"K\" Vector__XXX"));
  EXPECT_EQ(dbc.text.find(" : 12|"), std::string::npos) << "a signal has the reserved bit";
  EXPECT_EQ(dbc.text.find("SG_ word :"), std::string::npos);
}

TEST(Dbc, HasRealNumbersAndOtherTypesAsNumbers) {
  const Dbc dbc = dbc_from(pdo("1801", "1A01", "0x60001234", {"0x20010020"}) +
                           pdo("1802", "1A02", "$NODEID+0x380", {"0x20030030"}));
  EXPECT_TRUE(has_line(dbc, "BO_ 2147488308 drive_tpdo_2: 4 drive")) << dbc.text;  // 29 bits: 8000'1234h
  EXPECT_TRUE(has_line(dbc, " SG_ torque : 0|32@1+ (1,0) [0|0] \"Nm\" Vector__XXX"));
  EXPECT_TRUE(has_line(dbc, "SIG_VALTYPE_ 2147488308 torque : 1;"));
  EXPECT_TRUE(has_line(dbc, " SG_ clock : 0|48@1+ (1,0) [0|0] \"\" Vector__XXX"));
  EXPECT_TRUE(has_line(dbc, "CM_ SG_ 901 clock \"2003h:00 Clock, TIME_OF_DAY as a number\";"));
}

TEST(Dbc, HasGapsForDummyEntriesOfAnRpdo) {
  const Dbc dbc = dbc_from(pdo("1400", "1600", "$NODEID+0x200", {"0x00050008", "0x60400010"}));
  EXPECT_TRUE(has_line(dbc, "BO_ 517 drive_rpdo_1: 3 Vector__XXX")) << dbc.text;
  EXPECT_TRUE(has_line(dbc, " SG_ controlword : 8|16@1+ (1,0) [0|65535] \"\" drive"));
}

TEST(Dbc, ShortensLongNamesAndKeepsThemInAttributes) {
  const Dbc dbc = dbc_from(pdo("1800", "1A00", "$NODEID+0x180", {"0x20100108", "0x20100208"}),
                           "a_device_with_a_name_of_many_letters");
  EXPECT_TRUE(has_line(dbc, "BU_: a_device_with_a_name_of_many_let")) << dbc.text;
  EXPECT_TRUE(has_line(dbc, "BO_ 389 a_device_with_a_name_of_m_tpdo_1: 2 a_device_with_a_name_of_many_let"));
  EXPECT_TRUE(
      has_line(dbc, "BA_ \"SystemMessageLongSymbol\" BO_ 389 \"a_device_with_a_name_of_many_letters_tpdo_1\";"));
  EXPECT_NE(dbc.text.find(" SG_ axis_values_of_the_left_hand_sid : 0|8@1- (1,0) [-128|127]"), std::string::npos);
  EXPECT_NE(dbc.text.find(" SG_ axis_values_of_the_left_hand_s_2 : 8|8@1- (1,0) [-128|127]"), std::string::npos);
  EXPECT_TRUE(has_line(dbc,
                       "BA_ \"SystemSignalLongSymbol\" SG_ 389 axis_values_of_the_left_hand_s_2 "
                       "\"axis_values_of_the_left_hand_side_drive_slip\";"));
}

/// Readers replace the name of a signal by its long name, and reject two of one name in a message.
TEST(Dbc, HasDifferentLongNamesForAnObjectThatIsMappedTwice) {
  const Dbc dbc =
      dbc_from(pdo("1800", "1A00", "$NODEID+0x180", {"0x20100108", "0x60410010", "0x20100108", "0x60410010"}));
  EXPECT_NE(dbc.text.find(" SG_ statusword_2 : 32|16"), std::string::npos) << dbc.text;
  EXPECT_TRUE(has_line(dbc,
                       "BA_ \"SystemSignalLongSymbol\" SG_ 389 axis_values_of_the_left_hand_sid "
                       "\"axis_values_of_the_left_hand_side_drive_speed\";"));
  EXPECT_TRUE(has_line(dbc,
                       "BA_ \"SystemSignalLongSymbol\" SG_ 389 axis_values_of_the_left_hand_s_2 "
                       "\"axis_values_of_the_left_hand_side_drive_speed_2\";"));
}

TEST(Dbc, NamesSignalsAsTheEdsDoesWithoutReservedWordsOfALanguage) {
  const std::string mapped = "PDOMapping=1\n";
  const DeviceFromText read{var("2100", "Switch", "0x5", "ro", mapped) + var("2101", "Float", "0x5", "ro", mapped) +
                                var("2102", "Class", "0x5", "ro", mapped) + var("2103", "int", "0x5", "ro", mapped) +
                                var("2104", "Speed", "0x5", "ro", mapped) + var("2105", "SPEED", "0x5", "ro", mapped) +
                                group("2106", "Default", "0x9", 2) + sub("2106", 0, "Highest sub-index", "0x5") +
                                sub("2106", 1, "Type", "0x5", mapped) +
                                pdo("1800", "1A00", "$NODEID+0x180",
                                    {"0x21000008", "0x21010008", "0x21020008", "0x21030008", "0x21040008", "0x21050008",
                                     "0x21060108", "0x21000008"}),
                            {},
                            {.name = {}, .node_id = 5},
                            "signal.eds"};
  const Dbc dbc = dbc_of(read.device, read.names.identifiers());
  EXPECT_TRUE(has_line(dbc, "BU_: signal")) << dbc.text;
  EXPECT_TRUE(has_line(dbc, "BO_ 389 signal_tpdo_1: 8 signal"));
  unsigned start = 0;
  for (const char* name : {"switch", "float", "class", "int", "speed", "speed_2105", "default_type", "switch_2"}) {
    EXPECT_TRUE(has_line(
        dbc, " SG_ " + std::string{name} + " : " + std::to_string(start) + "|8@1+ (1,0) [0|255] \"\" Vector__XXX"))
        << name;
    start += 8;
  }
}

TEST(Dbc, NamesThePdosThatItDoesNotHave) {
  const Dbc dbc = dbc_from(pdo("1800", "1A00", "$NODEID+0x180", {"0x60410010"}) +
                           pdo("1801", "1A01", "$NODEID+0x180", {"0x60410010"}) +
                           pdo("1802", "1A02", "$NODEID+0x80000380", {"0x60410010"}) +
                           pdo("1803", "1A03", "$NODEID+0x80000480", {"0x60410010"}));
  EXPECT_EQ(dbc.notes, (std::vector<std::string>{"TPDO 2: CAN-ID 185h is used by another PDO",
                                                 "TPDO 3 to TPDO 4: disabled by default"}));
}

TEST(DbcString, CannotBeEndedByItsContents) {
  EXPECT_EQ(dbc_string("a \"b\"\n\xC2\xB5m \xCE\xBCm \xE2\x84\xA6"), "\"a 'b' \xB5m \xB5m ?\"");
}

}  // namespace
}  // namespace edsc
