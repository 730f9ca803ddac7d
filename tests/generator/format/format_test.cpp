/// The canonical form of an EDS or DCF (CiA 306-1).
#include "format/canonical_form.hpp"

#include <gtest/gtest.h>

#include <string>

#include "formatted.hpp"
#include "support/device_from_text.hpp"

namespace edsc {
namespace {

std::string formatted(std::string text) { return Formatted(std::move(text)).text(); }

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
  EXPECT_NE(text.find("SupportedObjects=2\n; one\n1=0x2000\n; two\n2=0x2001\n"), std::string::npos) << text;
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

}  // namespace
}  // namespace edsc
