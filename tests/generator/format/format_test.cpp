/// The canonical form of an EDS or DCF (CiA 306-1), and the DCF that it makes.
#include "format/canonical_form.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

#include "backend/json/device_view.hpp"
#include "device/resolve.hpp"
#include "eds/ini.hpp"
#include "format/dcf/make_dcf.hpp"
#include "format/spelling/key_table.hpp"
#include "format/spelling/number_spelling.hpp"
#include "support/device_from_text.hpp"
#include "text/source_file.hpp"

namespace edsc {
namespace {

/// A text and the results of each stage up to its canonical form.
struct Formatted {
  explicit Formatted(std::string text, std::optional<std::uint8_t> node_id = std::nullopt)
      : source("test.eds", std::move(text)),
        ini(parse_ini(source, diagnostics)),
        sheet(read_data_sheet(ini, diagnostics)),
        device(resolve_device(sheet, {}, node_id, diagnostics)) {}

  [[nodiscard]] std::string text() const { return to_text(canonical_form(ini, sheet, device)); }

  [[nodiscard]] std::string dcf(DcfValues values = DcfValues::different) const {
    Document document = canonical_form(ini, sheet, device);
    make_dcf(document, sheet, device, values);
    return to_text(document);
  }

  /// The device as `edsc dump` shows it, without line numbers.
  [[nodiscard]] nlohmann::ordered_json view() const {
    nlohmann::ordered_json view = device_view(device);
    remove_lines(view);
    return view;
  }

  static void remove_lines(nlohmann::ordered_json& view) {
    if (view.is_object()) view.erase("line");
    for (auto& member : view) {
      if (member.is_structured()) remove_lines(member);
    }
  }

  SourceFile source;
  Diagnostics diagnostics;
  IniFile ini;
  DataSheet sheet;
  Device device;
};

std::string formatted(std::string text) { return Formatted(std::move(text)).text(); }

/// [2000] with these keys after the usual ones.
std::string object_with(std::string_view data_type, std::string_view keys) {
  return "[2000]\nParameterName=a\nDataType=" + std::string{data_type} + "\nAccessType=rw\n" + std::string{keys};
}

/// The value that the canonical form gives to a key of such an object.
std::string spelled(std::string_view data_type, std::string_view key, std::string_view value) {
  const std::string line = std::string{key} + "=" + std::string{value} + "\n";
  const std::string text = formatted(object_with(data_type, line));
  const std::size_t start = text.find("\n" + std::string{key} + "=") + key.size() + 2;
  return text.substr(start, text.find('\n', start) - start);
}

std::string spelled_default(std::string_view data_type, std::string_view value) {
  return spelled(data_type, "DefaultValue", value);
}

TEST(CanonicalForm, IsItsOwnCanonicalForm) {
  const std::string once = formatted(
      "; about the file\r\n\r\n;about 2000\r\n[2000] # tail\r\nDataType = 7 ; u32\r\nPARAMETERNAME= a\r\nstray\r\n"
      "DefaultValue=0XfF\r\n[Tool x]\r\nA = b\r\n; end\r\n");
  EXPECT_EQ(formatted(once), once);
}

TEST(CanonicalForm, HasLineFeedsAndNoBlanksAroundEqualsSigns) {
  EXPECT_EQ(formatted("[ 2000 ]\r\n  ParameterName =  Speed of a motor \r\n\r\nDataType=0x7\r\nAccessType=ro"),
            "[ManufacturerObjects]\nSupportedObjects=1\n1=0x2000\n\n"
            "[2000]\nParameterName=Speed of a motor\nDataType=0x0007\nAccessType=ro\n");
}

TEST(CanonicalForm, HasSectionsInTheOrderOfCia306) {
  const std::string text = formatted(
      "[Other]\nA=1\n[2000sub0]\nDataType=5\n[2000]\nObjectType=8\n[1000]\nDataType=7\n[1008]\nDataType=9\n"
      "[Comments]\nLines=0\n[DummyUsage]\n[DeviceInfo]\n[FileInfo]\n[DeviceCommissioning]\n[ManufacturerObjects]\n");
  std::string titles;
  for (std::size_t at = text.find('['); at != std::string::npos; at = text.find('[', at + 1)) {
    titles += text.substr(at, text.find(']', at) + 1 - at);
  }
  EXPECT_EQ(titles,
            "[FileInfo][DeviceInfo][DummyUsage][Comments][DeviceComissioning][MandatoryObjects][1000]"
            "[OptionalObjects][1008][ManufacturerObjects][2000][2000sub0][Other]");
}

TEST(CanonicalForm, PutsTheListsOfACompactFormBehindItsObject) {
  const std::string text = formatted(
      "[1003Value]\nNrOfEntries=1\n1=0x5\n[1003Name]\nNrOfEntries=7\n2=b\n1=a\n"
      "[1003]\nParameterName=Errors\nObjectType=8\nDataType=7\nAccessType=ro\nCompactSubObj=2\n");
  EXPECT_NE(text.find("CompactSubObj=2\nDataType=7\nAccessType=ro\n\n[1003Name]\nNrOfEntries=2\n1=a\n2=b\n\n"
                      "[1003Value]\nNrOfEntries=1\n1=0x00000005\n"),
            std::string::npos)
      << text;
}

TEST(CanonicalForm, SpellsTitlesAndKeysAsCia306Does) {
  const std::string text =
      formatted("[FILEINFO]\nfilename=x\n[1a00SUB0a]\nparametername=a\ndatatype=0x5\n[40]\nparametername=t\n");
  EXPECT_NE(text.find("[FileInfo]\nFileName=x\n"), std::string::npos) << text;
  EXPECT_NE(text.find("[1A00subA]\nParameterName=a\nDataType=0x0005\n"), std::string::npos) << text;
  EXPECT_NE(text.find("[0040]\nParameterName=t\n"), std::string::npos) << text;
}

TEST(CanonicalForm, HasKeysInTheOrderOfCia306AndUnknownOnesBehind) {
  const std::string text = formatted(
      "[2000]\nShape=round\nPDOMapping=1\nDefaultValue=2\nHighLimit=3\nLowLimit=1\nAccessType=RW\nDataType=5\nColour="
      "red\n"
      "ObjectType=7\nParameterName=a\n");
  EXPECT_NE(text.find("[2000]\nParameterName=a\nObjectType=7\nDataType=5\nAccessType=rw\nLowLimit=1\nHighLimit=3\n"
                      "DefaultValue=2\nPDOMapping=1\nShape=round\nColour=red\n"),
            std::string::npos)
      << text;
}

TEST(CanonicalForm, KeepsUnknownSectionsAsTheyAre) {
  const std::string text = formatted("[2000]\nDataType=5\n[My Section]\nb = 0x0a\na=\nb=2\n");
  EXPECT_NE(text.find("[My Section]\nb=0x0a\na=\nb=2\n"), std::string::npos) << text;
}

TEST(CanonicalForm, InventsNoKey) {
  EXPECT_EQ(formatted("[2000]\nDataType=0x0005\n"),
            "[ManufacturerObjects]\nSupportedObjects=1\n1=0x2000\n\n[2000]\nDataType=0x0005\n");
}

TEST(CanonicalForm, KeepsAnEmptyValue) { EXPECT_EQ(spelled_default("0x0007", ""), ""); }

TEST(CanonicalForm, WritesTheObjectListsAnew) {
  const std::string text = formatted(
      "[OptionalObjects]\nSupported Objects=9\n1=0x2001\n2=0x2002\n7=8192\n"
      "[2001]\nDataType=5\n[2000]\nDataType=5\n[1005]\nDataType=7\n");
  EXPECT_NE(text.find("[OptionalObjects]\nSupportedObjects=1\n1=0x1005\n"), std::string::npos) << text;
  EXPECT_NE(text.find("[ManufacturerObjects]\nSupportedObjects=2\n1=0x2000\n2=0x2001\n"), std::string::npos) << text;
  EXPECT_EQ(text.find("2002"), std::string::npos) << text;
}

TEST(CanonicalForm, CountsSubObjectsInTheBaseOfTheOldNumber) {
  const std::string subs = "[2000sub0]\nDataType=5\n[2000sub1]\nDataType=5\n";
  EXPECT_NE(formatted("[2000]\nObjectType=9\nSubNumber=7\n" + subs).find("SubNumber=2\n"), std::string::npos);
  EXPECT_NE(formatted("[2000]\nObjectType=9\nSubNumber=0x07\n" + subs).find("SubNumber=0x2\n"), std::string::npos);
}

TEST(CanonicalForm, KeepsTheFirstOfTwoSectionsAndTheCommentsOfBoth) {
  const std::string text = formatted(
      "; first\n[2000]\nParameterName=a\nDataType=5\n; second\n[2000]\n; in second\nParameterName=b\nDataType=7\n");
  EXPECT_NE(text.find("; first\n; second\n; in second\n[2000]\nParameterName=a\nDataType=5\n"), std::string::npos)
      << text;
  EXPECT_EQ(text.find("ParameterName=b"), std::string::npos);
}

TEST(CanonicalForm, KeepsTheFirstOfTwoKeysAndTheCommentsOfBoth) {
  const std::string text = formatted("[2000]\nParameterName=a\n; again\nParameterName=b\nDataType=5\n");
  EXPECT_NE(text.find("[2000]\n; again\nParameterName=a\nDataType=5\n"), std::string::npos) << text;
}

TEST(CanonicalForm, KeepsCommentsBeforeTheKeyOrSectionThatTheyStandBefore) {
  const std::string text = formatted(
      "[2001]\nDataType=5\n;of 2000\n[2000]\n; of the type\nDataType=5\n# of the name\nParameterName=a\n; at the "
      "end\n");
  EXPECT_NE(text.find(";of 2000\n[2000]\n; of the name\nParameterName=a\n; of the type\nDataType=5\n\n[2001]"),
            std::string::npos)
      << text;
  EXPECT_TRUE(text.ends_with("[2001]\nDataType=5\n\n; at the end\n")) << text;
}

TEST(CanonicalForm, KeepsACommentAboutTheFileAtItsTop) {
  const std::string text =
      formatted("; licence\n; and more\n\n; of 2000\n[2000]\nDataType=5\n[FileInfo]\nFileName=a\n");
  EXPECT_TRUE(text.starts_with("; licence\n; and more\n\n[FileInfo]\n")) << text;
  EXPECT_NE(text.find("\n\n; of 2000\n[2000]\n"), std::string::npos) << text;
}

TEST(CanonicalForm, TurnsStrayLinesIntoComments) {
  const std::string text = formatted("[2000] more\nsome words\nDataType=5\n");
  EXPECT_NE(text.find("; more\n[2000]\n; some words\nDataType=5\n"), std::string::npos) << text;
}

TEST(CanonicalForm, PutsCommentsBehindNumbersBeforeTheirKey) {
  const std::string text =
      formatted("[2000]\nParameterName=a ; b # c\nDataType=0x5 # UNSIGNED8\nAccessType=RO ; fixed\n");
  EXPECT_NE(text.find("ParameterName=a ; b # c\n; UNSIGNED8\nDataType=0x0005\n; fixed\nAccessType=ro\n"),
            std::string::npos)
      << text;
}

TEST(CanonicalForm, KeepsTheCommentOfAListedObject) {
  const std::string text = formatted(
      "[ManufacturerObjects]\nSupportedObjects=2\n; two\n1=0x2001\n2=0x2000 ; one\n"
      "[2001]\nDataType=5\n[2000]\nDataType=5\n");
  EXPECT_NE(text.find("SupportedObjects=2\n1=0x2000\n; two\n2=0x2001\n"), std::string::npos) << text;
}

TEST(CanonicalForm, KeepsTheCommentBeforeTheNumberOfListedObjects) {
  for (const char* list : {"MandatoryObjects", "OptionalObjects", "ManufacturerObjects"}) {
    for (const char* key : {"SupportedObjects=1", "Supported Objects=1", "SUPPORTEDOBJECTS=0x1 ; one"}) {
      const std::string text =
          formatted(std::string{"["} + list + "]\n; about the list\n" + key + "\n1=0x2000\n[2000]\nDataType=5\n");
      EXPECT_NE(text.find("; about the list\n"), std::string::npos) << list << ' ' << key << '\n' << text;
    }
  }
  const std::string text =
      formatted("[ManufacturerObjects]\n; about the list\nSupportedObjects=1\n1=0x2000\n[2000]\nDataType=5\n");
  EXPECT_NE(text.find("[ManufacturerObjects]\n; about the list\nSupportedObjects=1\n1=0x2000\n"), std::string::npos)
      << text;
}

TEST(CanonicalForm, KeepsCommentsOfAListThatHasNoObjects) {
  const std::string text =
      formatted("[OptionalObjects]\n; none yet\nSupportedObjects=0\n; gone\n1=0x1008\n[2000]\nDataType=5\n");
  EXPECT_NE(text.find("[OptionalObjects]\n; none yet\n; gone\nSupportedObjects=0\n"), std::string::npos) << text;
}

TEST(CanonicalForm, KeepsCommentsOfBothWhenAListIsThereTwice) {
  const std::string text = formatted(
      "[ManufacturerObjects]\n; first\nSupportedObjects=1\n1=0x2000\n"
      "[ManufacturerObjects]\n; second\nSupportedObjects=1\n1=0x2000\n[2000]\nDataType=5\n");
  EXPECT_NE(text.find("; first\n"), std::string::npos) << text;
  EXPECT_NE(text.find("; second\n"), std::string::npos) << text;
}

TEST(CanonicalForm, KeepsBaseAndValueOfNumbers) {
  EXPECT_EQ(spelled_default("0x0007", "0xabc"), "0x00000ABC");
  EXPECT_EQ(spelled_default("0x0006", "0XABC"), "0x0ABC");
  EXPECT_EQ(spelled_default("0x0005", "0x0000a"), "0x0A");
  EXPECT_EQ(spelled_default("0x0005", "0x1FF"), "0x1FF");
  EXPECT_EQ(spelled_default("0x0001", "0x01"), "0x1");
  EXPECT_EQ(spelled_default("0x0016", "0xA"), "0x00000A");
  EXPECT_EQ(spelled_default("0x0007", "0010"), "010");
  EXPECT_EQ(spelled_default("0x0007", "000"), "0");
  EXPECT_EQ(spelled_default("0x0007", "0089"), "89");
  EXPECT_EQ(spelled_default("0x0007", "+5"), "5");
  EXPECT_EQ(spelled_default("0x0003", "-0x7f"), "-0x007F");
  EXPECT_EQ(spelled_default("0x0003", "-5"), "-5");
  EXPECT_EQ(spelled_default("0x0003", "0xffff"), "0xFFFF");
  EXPECT_EQ(spelled_default("0x0015", "0x12LL"), "0x0000000000000012");
}

TEST(CanonicalForm, GivesLimitsTheWidthOfTheType) {
  EXPECT_EQ(spelled("0x0006", "LowLimit", "0x1"), "0x0001");
  EXPECT_EQ(spelled("0x0006", "HighLimit", "0xfff"), "0x0FFF");
}

TEST(CanonicalForm, KeepsWhatIsNoNumber) {
  EXPECT_EQ(spelled_default("0x0007", "see manual"), "see manual");
  EXPECT_EQ(spelled_default("0x0007", "12 apples"), "12 apples");
  EXPECT_EQ(spelled("0x0007", "PDOMapping", "yes"), "yes");
  EXPECT_EQ(spelled("banana", "DefaultValue", "0xa"), "0xa");
}

TEST(CanonicalForm, KeepsStringsLetterByLetter) {
  EXPECT_EQ(spelled_default("0x0009", "000 ; 0xa # b"), "000 ; 0xa # b");
  EXPECT_EQ(spelled_default("0x000A", "0a 0b"), "0a 0b");
}

TEST(CanonicalForm, KeepsDecimalsOfReals) {
  EXPECT_EQ(spelled_default("0x0008", "12.50"), "12.50");
  EXPECT_EQ(spelled_default("0x0008", "010"), "010");
  EXPECT_EQ(spelled_default("0x0008", "0x3f800000"), "0x3F800000");
}

TEST(CanonicalForm, SpellsFormulasInOneWay) {
  for (const char* formula :
       {"$NODEID+0x180", "0x180+$NODEID", "$NodeId + 0x0180", "$MY_NODE_ID+0x180", "$NODEID +0x180u"}) {
    EXPECT_EQ(spelled_default("0x0007", formula), "$NODEID+0x180") << formula;
  }
  EXPECT_EQ(spelled_default("0x0007", "1280 + $nodeid"), "$NODEID+1280");
  EXPECT_EQ(spelled_default("0x0007", "$nodeid"), "$NODEID");
  EXPECT_EQ(spelled_default("0x0007", "$NODEID*2"), "$NODEID*2");
}

TEST(CanonicalForm, TakesTheTypeOfADeftype) {
  const std::string text =
      formatted("[0040]\nParameterName=t\nObjectType=5\nDataType=0x7\n" + object_with("0x0040", "DefaultValue=0xa\n"));
  EXPECT_NE(text.find("DefaultValue=0x0000000A\n"), std::string::npos) << text;
}

TEST(CanonicalForm, IsTheSameDevice) {
  const std::string text =
      "[DeviceInfo]\nVendorNumber=0x1 ; us\n[2001]\nParameterName=b\nDataType=7\nAccessType=RW\nDefaultValue=0x180 + "
      "$NODEID\n"
      "[2000]\nParameterName=a\nObjectType=8\nCompactSubObj=3\nDataType=0x3\nAccessType=rww\nDefaultValue=-1\n["
      "2000Value]\n"
      "NrOfEntries=1\n2=0xFFFE\n";
  EXPECT_EQ(Formatted(formatted(text)).view(), Formatted(text).view());
}

TEST(KeyTable, SpellsEveryKeyThatItKnows) {
  EXPECT_EQ(spell_key(SectionKind::device_info, "baudrate_500").name, "BaudRate_500");
  EXPECT_EQ(spell_key(SectionKind::dummy_usage, "dummy001a").name, "Dummy001A");
  EXPECT_EQ(spell_key(SectionKind::device_commissioning, "nodeid").name, "NodeID");
  EXPECT_FALSE(spell_key(SectionKind::sub_object, "SubNumber").is_known);
  EXPECT_FALSE(spell_key(SectionKind::unknown, "ParameterName").is_known);
}

constexpr std::string_view two_entries =
    "[FileInfo]\nFileName=pump.eds\n\n"
    "[2000]\nParameterName=a\nObjectType=0x7\nDataType=0x0007\nAccessType=rw\nDefaultValue=$NODEID+0x180\n"
    "ParameterValue=7\n\n"
    "[2001]\nParameterName=b\nObjectType=0x7\nDataType=0x0007\nAccessType=ro\nDefaultValue=$NODEID+0x200\n";

TEST(MakeDcf, GivesAllWritableEntriesTheirValueWhenAsked) {
  const std::string dcf = Formatted(std::string{two_entries}, std::uint8_t{5}).dcf(DcfValues::all);
  EXPECT_NE(dcf.find("DefaultValue=$NODEID+0x180\nParameterValue=0x00000185\n"), std::string::npos) << dcf;
  EXPECT_TRUE(dcf.ends_with("AccessType=ro\nDefaultValue=$NODEID+0x200\n")) << dcf;
}

TEST(MakeDcf, HasNoValueThatTheDefaultGives) {
  EXPECT_EQ(Formatted(std::string{two_entries}, std::uint8_t{5}).dcf().find("ParameterValue"), std::string::npos);
}

TEST(MakeDcf, DropsAValueThatIsTheDefaultForTheNode) {
  const std::string text = "[DeviceComissioning]\nNodeID=5\n" + object_with("0x0007",
                                                                            "DefaultValue=$NODEID+2\n"
                                                                            "ParameterValue=0x7\n");
  EXPECT_EQ(Formatted(text, std::uint8_t{5}).dcf().find("ParameterValue"), std::string::npos);
  EXPECT_NE(Formatted(text, std::uint8_t{5}).dcf(DcfValues::all).find("ParameterValue=0x00000007\n"),
            std::string::npos);
  EXPECT_NE(Formatted(text, std::uint8_t{6}).dcf().find("ParameterValue=0x00000007\n"), std::string::npos);
}

/// A configuration tool writes number and entries of a mapping together; a part of them would be another mapping.
TEST(MakeDcf, KeepsAMappingTogether) {
  const auto entry = [](int sub_index, std::string_view type, std::string_view keys) {
    return fmt::format("\n[1A00sub{}]\nParameterName=n\nObjectType=7\nDataType={}\nAccessType=rw\n{}", sub_index, type,
                       keys);
  };
  const std::string text = "[DeviceComissioning]\nNodeID=5\n\n[1A00]\nParameterName=m\nObjectType=9\nSubNumber=3\n" +
                           entry(0, "5", "DefaultValue=2\n") + entry(1, "7", "DefaultValue=0x60410010\n") +
                           entry(2, "7", "DefaultValue=0x60640020\nParameterValue=0x60640120\n");
  const std::string dcf = Formatted(text, std::uint8_t{5}).dcf();
  EXPECT_NE(dcf.find("DefaultValue=2\nParameterValue=2\n"), std::string::npos) << dcf;
  EXPECT_NE(dcf.find("ParameterValue=0x60410010\n"), std::string::npos) << dcf;
  EXPECT_NE(dcf.find("ParameterValue=0x60640120\n"), std::string::npos) << dcf;
}

TEST(MakeDcf, CommissionsTheNode) {
  const std::string dcf = Formatted(std::string{two_entries}, std::uint8_t{5}).dcf();
  EXPECT_TRUE(
      dcf.starts_with("[FileInfo]\nFileName=pump.eds\nLastEDS=pump.eds\n\n"
                      "[DeviceComissioning]\nNodeID=5\nNodeName=\nNetNumber=0\nNetworkName=\nCANopenManager=0\n\n"))
      << dcf;
}

TEST(MakeDcf, IsTheDeviceWithItsNodeId) {
  const Formatted eds(std::string{two_entries}, std::uint8_t{5});
  const Formatted dcf(eds.dcf());
  EXPECT_EQ(dcf.device.node_id, 5);
  EXPECT_EQ(dcf.view()["objects"], eds.view()["objects"]);
}

TEST(MakeDcf, KeepsTheValuesOfADcf) {
  const std::string dcf = Formatted("[DeviceComissioning]\nNodeID=9\nNodeName=axis\n" +
                                        object_with("0x0007", "DefaultValue=1\nParameterValue=$NODEID+2\n"),
                                    std::uint8_t{5})
                              .dcf();
  EXPECT_NE(dcf.find("NodeID=5\nNodeName=axis\n"), std::string::npos) << dcf;
  EXPECT_NE(dcf.find("DefaultValue=1\nParameterValue=0x00000007\n"), std::string::npos) << dcf;
}

TEST(MakeDcf, DropsAValueOfAnEds) {
  const std::string eds = object_with("0x0007", "DefaultValue=\nParameterValue=7\n");
  EXPECT_EQ(Formatted(eds, std::uint8_t{5}).dcf().find("ParameterValue"), std::string::npos);
}

TEST(MakeDcf, GivesCommandsNoValue) {
  const std::string stores = group("1010", "Store parameters", "8", 2) +
                             var("1010sub0", "Highest sub-index", "5", "ro", "DefaultValue=1\n") +
                             var("1010sub1", "Save all", "7", "rw", "DefaultValue=1\nParameterValue=0x65766173\n");
  const std::string clears = group("1003", "Errors", "8", 2) +
                             var("1003sub0", "Number of errors", "5", "rw", "DefaultValue=0\n") +
                             var("1003sub1", "Error", "7", "ro");
  const std::string control = group("1F51", "Program control", "8", 1) +
                              "DataType=5\nAccessType=rw\nCompactSubObj=1\n" + "[1F51Value]\nNrOfEntries=1\n1=1\n";
  const std::string other = var("2000", "Value", "5", "rw", "DefaultValue=3\n");
  for (const std::string& head : {std::string{}, std::string{"[DeviceComissioning]\nNodeID=5\n"}}) {
    const std::string dcf = Formatted(head + clears + stores + control + other, std::uint8_t{5}).dcf(DcfValues::all);
    const std::string_view value = "ParameterValue=";
    const std::size_t first = dcf.find(value);
    EXPECT_EQ(dcf.find("ParameterValue=3"), first) << dcf;
    EXPECT_EQ(dcf.find(value, first + 1), std::string::npos) << dcf;
    EXPECT_EQ(dcf.find("[1F51Value]"), std::string::npos) << dcf;
  }
}

TEST(MakeDcf, ConfiguresNoValueInPlaceOfThatOfCia301) {
  const std::string eds = "[1014]\nParameterName=COB-ID EMCY\nDataType=0x0007\nAccessType=rw\nDefaultValue=";
  const auto dcf = [&](const std::string& value) {
    return Formatted(eds + value, std::uint8_t{5}).dcf(DcfValues::all);
  };
  EXPECT_EQ(dcf("0\n").find("ParameterValue"), std::string::npos) << "CAN-ID 0";
  EXPECT_NE(dcf("$NODEID+0x80\n").find("ParameterValue=0x00000085"), std::string::npos);
}

TEST(MakeDcf, HasTheBitRateOfADeviceThatHasOnlyOne) {
  const std::string info = "[DeviceInfo]\nBaudRate_125=0\nBaudRate_250=1\n";
  EXPECT_NE(Formatted(info + object_with("5", ""), std::uint8_t{5}).dcf().find("Baudrate=250\n"), std::string::npos);
}

}  // namespace
}  // namespace edsc
