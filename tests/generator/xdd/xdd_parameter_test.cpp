/// The parameters of an XDD that objects refer to.
#include "device/meaning/resolve_meaning.hpp"
#include "xdd/read_xdd.hpp"

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

#include "support/diagnostic_matchers.hpp"
#include "xdd_profile.hpp"

namespace edsc {
namespace {

using Findings = std::vector<Finding>;

TEST(XddParameter, GivesTypeAccessValuesAndLimits) {
  const ReadXdd read(
      Profile{referring_object,
              parameter("<label lang='de'>Drehzahl</label><label "
                        "lang='en'>Speed</label><UINT/><denotation><label>axis</label></denotation>"
                        "<actualValue value='8'/><defaultValue value='7'/><allowedValues><range><minValue value='1'/>"
                        "<maxValue value='9'/></range></allowedValues>",
                        "access='readWrite'"),
              "", ""});
  EXPECT_EQ(findings(read.diagnostics), Findings{});
  const ObjectDescription& object = read.object();
  EXPECT_EQ(object.parameter_name.text, "x");
  EXPECT_EQ(object.data_type.text, "0x0006");
  EXPECT_EQ(object.access_type.text, "rw");
  EXPECT_EQ(object.default_value.text, "7");
  EXPECT_EQ(object.default_value.position.line, 2U);
  EXPECT_EQ(object.parameter_value.text, "8");
  EXPECT_EQ(object.low_limit.text, "1");
  EXPECT_EQ(object.high_limit.text, "9");
  EXPECT_EQ(object.denotation.text, "axis");
}

TEST(XddParameter, NamesAnObjectWithoutName) {
  const ReadXdd read(Profile{"<CANopenObject index='2000' uniqueIDRef='p'/>",
                             parameter("<label lang='de'>Drehzahl</label><label lang='en'>Speed</label>"), "", ""});
  EXPECT_EQ(read.object().parameter_name.text, "Speed");
}

TEST(XddParameter, IsReadOnlyWhenNeitherItNorTheObjectSaysMore) {
  EXPECT_EQ(ReadXdd(Profile{referring_object, parameter("<UINT/>"), "", ""}).object().access_type.text, "ro");
  const ReadXdd own(
      Profile{"<CANopenObject index='2000' accessType='rw' uniqueIDRef='p'/>", parameter("<UINT/>"), "", ""});
  EXPECT_EQ(own.object().access_type.text, "rw");
}

struct AccessCase {
  std::string_view word;
  std::string_view access_type;
};

TEST(XddParameter, SpellsTheAccessAsAnEdsDoes) {
  constexpr AccessCase cases[] = {{"const", "const"},        {"read", "ro"},
                                  {"write", "wo"},           {"readWrite", "rw"},
                                  {"readWriteInput", "rwr"}, {"readWriteOutput", "rww"}};
  for (const AccessCase& one : cases) {
    const ReadXdd document(
        Profile{referring_object, parameter("<INT/>", "access='" + std::string{one.word} + "'"), "", ""});
    EXPECT_EQ(document.object().access_type.text, one.access_type);
  }
  const ReadXdd none(Profile{referring_object, parameter("<INT/>", "access='noAccess'"), "", ""});
  EXPECT_EQ(none.object().access_type.text, "ro");
  EXPECT_EQ(findings(none.diagnostics).size(), 1U);
}

struct TypeCase {
  std::string_view name;
  std::string_view data_type;
};

TEST(XddParameter, TakesTheTypesOfIec61131ForThoseOfCanopen) {
  constexpr TypeCase cases[] = {{"BOOL", "0x0001"},   {"SINT", "0x0002"},  {"INT", "0x0003"},   {"DINT", "0x0004"},
                                {"LINT", "0x0015"},   {"USINT", "0x0005"}, {"UINT", "0x0006"},  {"UDINT", "0x0007"},
                                {"ULINT", "0x001B"},  {"BYTE", "0x0005"},  {"WORD", "0x0006"},  {"DWORD", "0x0007"},
                                {"LWORD", "0x001B"},  {"REAL", "0x0008"},  {"LREAL", "0x0011"}, {"STRING", "0x0009"},
                                {"WSTRING", "0x000B"}};
  for (const TypeCase& one : cases) {
    const ReadXdd read(Profile{referring_object, parameter("<" + std::string{one.name} + "/>"), "", ""});
    EXPECT_EQ(read.object().data_type.text, one.data_type) << one.name;
  }
}

TEST(XddParameter, TakesABitStringWithoutValueForADomain) {
  EXPECT_EQ(ReadXdd(Profile{referring_object, parameter("<BITSTRING/>"), "", ""}).object().data_type.text, "0x000F");
  const ReadXdd bytes(Profile{referring_object, parameter("<BITSTRING/><defaultValue value='01 FF'/>"), "", ""});
  EXPECT_EQ(bytes.object().data_type.text, "0x000A");
}

TEST(XddParameter, SpellsTruthAsANumber) {
  const ReadXdd read(Profile{referring_object + "<CANopenObject index='2001' dataType='01' defaultValue='false'/>",
                             parameter("<BOOL/><defaultValue value='true'/>"), "", ""});
  EXPECT_EQ(read.object(0).default_value.text, "1");
  EXPECT_EQ(read.object(1).default_value.text, "0");
}

TEST(XddParameter, FollowsEnumsAndDerivedTypes) {
  const ReadXdd read(Profile{referring_object,
                             "<dataTypeList><derived uniqueID='d'><dataTypeIDRef uniqueIDRef='e'/></derived>"
                             "<enum uniqueID='e'><USINT/><enumValue value='0'/></enum></dataTypeList>" +
                                 parameter("<dataTypeIDRef uniqueIDRef='d'/>"),
                             "", ""});
  EXPECT_EQ(findings(read.diagnostics), Findings{});
  EXPECT_EQ(read.object().data_type.text, "0x0005");
}

TEST(XddParameter, NamesTheValuesOfAnEnum) {
  const ReadXdd read(Profile{
      referring_object,
      "<dataTypeList><enum uniqueID='e'><SINT/><enumValue value='-1'><label lang='en'>Homing run"
      "</label></enumValue><enumValue value='3'><label lang='de'>Drehzahl</label><label lang='en'>"
      "Velocity</label></enumValue><enumValue value='4'/><enumValue value='300'><label>Far</label></enumValue></enum></dataTypeList>" +
          parameter("<dataTypeIDRef uniqueIDRef='e'/>"),
      "", ""});
  EXPECT_EQ(findings(read.diagnostics), Findings{});
  Diagnostics diagnostics;
  const auto names = names_of_values(read.object(), *canopen::find_data_type(2), diagnostics);
  ASSERT_TRUE(names.has_value());
  ASSERT_EQ(names->values.size(), 2U);
  EXPECT_EQ(names->values[0].value, -1);
  EXPECT_EQ(names->values[0].name, "homing_run");
  EXPECT_EQ(names->values[1].value, 3);
  EXPECT_EQ(names->values[1].name, "velocity");
  EXPECT_EQ(findings(diagnostics).size(), 1U) << "300 is not an INTEGER8";
}

TEST(XddParameter, NamesTheAllowedValues) {
  const ReadXdd read(Profile{referring_object,
                             parameter("<USINT/><allowedValues><value value='0'><label lang='en'>Off</label></value>"
                                       "<value value='1'><label lang='en'>On</label></value></allowedValues>"),
                             "", ""});
  Diagnostics diagnostics;
  const auto names = names_of_values(read.object(), *canopen::find_data_type(5), diagnostics);
  ASSERT_TRUE(names.has_value());
  EXPECT_EQ(names->values.at(1).name, "on");
}

TEST(XddParameter, HasAUnitWithOneMultiplier) {
  const auto unit = [](const std::string& attributes, const std::string& multiplier) {
    const ReadXdd read(Profile{referring_object,
                               "<parameterList><parameter uniqueID='p' " + attributes + "><INT/><unit multiplier='" +
                                   multiplier + "'><label lang='en'>°C</label></unit></parameter></parameterList>",
                               "", ""});
    return std::string{read.object().unit.text} + " " + std::string{read.object().factor.text};
  };
  EXPECT_EQ(unit("", "0.1"), "°C 0.1");
  EXPECT_EQ(unit("multiplier='0.5'", "1"), "°C 0.5");
  EXPECT_EQ(unit("offset='0' multiplier='1'", "0.1"), "°C 0.1");
  EXPECT_EQ(unit("multiplier='0.5'", "0.1"), " ") << "two multipliers";
}

/// (value + offset) * multiplier is value * Factor + Offset.
TEST(XddParameter, HasAnOffsetBeforeItsMultiplier) {
  const auto unit = [](const std::string& attributes) {
    const ReadXdd read(Profile{referring_object,
                               "<parameterList><parameter uniqueID='p' " + attributes +
                                   "><INT/><unit><label lang='en'>°C</label></unit></parameter></parameterList>",
                               "", ""});
    return std::string{read.object().factor.text} + " " + std::string{read.object().offset.text};
  };
  EXPECT_EQ(unit("offset='-40' multiplier='0.5'"), "0.5 -20");
  EXPECT_EQ(unit("offset='-400' multiplier='0.125'"), "0.125 -50");
  EXPECT_EQ(unit("offset='3' multiplier='0.05'"), "0.05 0.15");
  EXPECT_EQ(unit("offset='-0.3' multiplier='-0.01'"), "-0.01 0.003");
  EXPECT_EQ(unit("offset='20' multiplier='1'"), " 20") << "without a multiplier, the offset is in the unit";
  EXPECT_EQ(unit("offset='20'"), " 20");
  EXPECT_EQ(unit("offset='1e3' multiplier='0.5'"), " ") << "not a decimal";
}

TEST(XddParameter, EndsAtATypeThatIsDerivedFromItself) {
  const ReadXdd read(
      Profile{referring_object,
              "<dataTypeList><derived uniqueID='d'><dataTypeIDRef uniqueIDRef='d'/></derived></dataTypeList>" +
                  parameter("<dataTypeIDRef uniqueIDRef='d'/>"),
              "", ""});
  EXPECT_FALSE(read.object().data_type.present);
}

TEST(XddParameter, GivesSubObjectsTheTypesOfItsArrayOrStruct) {
  const ReadXdd read(
      Profile{"<CANopenObject index='2000' objectType='8' uniqueIDRef='p'><CANopenSubObject subIndex='00' "
              "dataType='0005' accessType='const'/>"
              "<CANopenSubObject subIndex='01' PDOmapping='RPDO'/></CANopenObject>"
              "<CANopenObject index='2001' objectType='9' uniqueIDRef='q'><CANopenSubObject subIndex='01' "
              "name='ratio'/></CANopenObject>",
              "<dataTypeList><array uniqueID='a'><subrange lowerLimit='0' upperLimit='1'/><DINT/></array>"
              "<struct uniqueID='s'><varDeclaration name='count' uniqueID='v'><USINT/></varDeclaration>"
              "<varDeclaration name='ratio' uniqueID='w'><REAL/></varDeclaration></struct></dataTypeList>"
              "<parameterList><parameter uniqueID='p' access='readWrite'><dataTypeIDRef uniqueIDRef='a'/></parameter>"
              "<parameter uniqueID='q'><dataTypeIDRef uniqueIDRef='s'/></parameter></parameterList>",
              "", ""});
  EXPECT_EQ(findings(read.diagnostics), Findings{});
  const auto& array = read.object(0).sub_objects;
  EXPECT_EQ(array.at(0).data_type.text, "0x0005");
  EXPECT_EQ(array.at(0).access_type.text, "const");
  EXPECT_EQ(array.at(1).data_type.text, "0x0004");
  EXPECT_EQ(array.at(1).access_type.text, "rww");
  EXPECT_EQ(read.object(1).sub_objects.at(0).data_type.text, "0x0008");
  EXPECT_EQ(read.object(1).sub_objects.at(0).access_type.text, "ro");
}

TEST(XddParameter, LeavesToItsTemplateWhatItDoesNotSay) {
  const ReadXdd read(
      Profile{referring_object,
              "<templateList><parameterTemplate uniqueID='t' access='readWrite'><UINT/><defaultValue value='1'/>"
              "</parameterTemplate></templateList>" +
                  parameter("<defaultValue value='2'/>", "templateIDRef='t'"),
              "", ""});
  EXPECT_EQ(read.object().data_type.text, "0x0006");
  EXPECT_EQ(read.object().access_type.text, "rw");
  EXPECT_EQ(read.object().default_value.text, "2");
}

TEST(XddParameter, WarnsOfAllowedValuesThatAreNoRange) {
  const ReadXdd read(Profile{referring_object,
                             parameter("<UINT/><allowedValues><value value='1'/><value value='5'/></allowedValues>"),
                             "", ""});
  EXPECT_EQ(findings(read.diagnostics, "xml-element").size(), 1U);
  EXPECT_FALSE(read.object().low_limit.present);
}

TEST(XddParameter, WarnsOfAReferenceToNothing) {
  const ReadXdd read(Profile{referring_object, "", "", ""});
  EXPECT_EQ(findings(read.diagnostics), (Findings{warning_at(first_line, 66, "xml-element")}));
}

TEST(XddParameter, LeavesOutAnObjectThatCanopenEditorHasDisabled) {
  const ReadXdd read(Profile{referring_object + "<CANopenObject index='2001'/>",
                             parameter("<UINT/><property name='CO_disabled' value='true'/>"), "", ""});
  EXPECT_EQ(findings(read.diagnostics), (Findings{note_at(first_line, 2, "xml-element")}));
  ASSERT_EQ(read.sheet.objects.size(), 1U);
  EXPECT_EQ(read.object().index, 0x2001);
}

}  // namespace
}  // namespace edsc
