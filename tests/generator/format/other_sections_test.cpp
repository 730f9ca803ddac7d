/// The canonical form of sections other than those of objects: comments, tools, dynamic channels and modules.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "formatted.hpp"

namespace edsc {
namespace {

constexpr const char* one_object = "[2000]\nParameterName=a\nDataType=0x0005\nAccessType=ro\n";

/// The canonical form of these sections and one object.
std::string form_of(const std::string& sections) { return Formatted(sections + one_object).text(); }

void expect_part(const std::string& sections, const std::string& part) {
  const std::string text = form_of(sections);
  EXPECT_NE(text.find(part), std::string::npos) << text;
}

TEST(OtherSections, OfToolsAreSpelledCountedAndInTheirOrder) {
  expect_part("[TOOL02]\ncommand=b.exe\nNAME=B\n[tools]\nitems=0x1 ; one\n[tool1]\nName=A\n",
              "[Tools]\n; one\nItems=2\n\n[Tool1]\nName=A\n\n[Tool2]\nName=B\nCommand=b.exe\n");
}

TEST(OtherSections, OfDynamicChannelsHaveTheKeysOfASegmentTogether) {
  expect_part(
      "[dynamicchannels]\ntype2=0X5\nppoffset1=0x0a ; bytes\nrange1=0xa080 - 0xA0bf\ndir1=RO\ntype1=7\nnrofseg=9\n"
      "Range2=0xa0c0\nRange3=A0 ; hex\n",
      "[DynamicChannels]\nNrOfSeg=3\nType1=7\nDir1=RO\nRange1=0xA080-0xA0BF\n; bytes\nPPOffset1=0xA\nType2=0x0005\n"
      "Range2=0xA0C0\nRange3=A0 ; hex\n");
}

TEST(OtherSections, OfModulesAreTogetherAndSpelled) {
  const std::string modules =
      "[connectedmodules]\n1=0x1\nnrofentries=1\n"
      "[M2moduleinfo]\nproductname=B\n"
      "[m01Comments]\nline1=text\nlines=3\n"
      "[M1SubExt6000]\nobjextend=0X0\ncount=0 ; 4\ndatatype=5\nDefaultValue=0xa\n"
      "[m1subextends]\nnrofentries=7\n1=0x6000\n"
      "[M1FIXED2100SUB1]\ndatatype=0x6\nparametername=s\nDefaultValue=0xab\n[M1Fixed2100]\nSubNumber=9\nParameterName=f\n"
      "[M1FixedObjects]\n1=0x21aa\n2=8448\nNrOfEntries=2 ; both\n"
      "[m1MODULEINFO]\nordercode=o\nproductrevision=0x0f\nproductversion=1\nproductname=A\n"
      "[supportedmodules]\nnrofentries=0\n";
  expect_part(modules,
              "[SupportedModules]\nNrOfEntries=2\n\n"
              "[M1ModuleInfo]\nProductName=A\nProductVersion=1\nProductRevision=0xF\nOrderCode=o\n\n"
              "[M1FixedObjects]\n; both\nNrOfEntries=2\n1=0x21AA\n2=8448\n\n"
              "[M1Fixed2100]\nParameterName=f\nSubNumber=1\n\n"
              "[M1Fixed2100sub1]\nParameterName=s\nDataType=0x0006\nDefaultValue=0x00AB\n\n"
              "[M1SubExtends]\nNrOfEntries=1\n1=0x6000\n\n"
              "[M1SubExt6000]\nDataType=5\nDefaultValue=0x0A\nCount=0;4\nObjExtend=0x0\n\n"
              "[M1Comments]\nLines=1\nLine1=text\n\n"
              "[M2ModuleInfo]\nProductName=B\n\n"
              "[ConnectedModules]\nNrOfEntries=1\n1=0x1\n");
}

TEST(OtherSections, OfAModuleHaveTheDataTypesOfItsObjects) {
  // 2100h of the device has another data type than 2100h of the module.
  const std::string text = form_of(
      "[2100]\nParameterName=d\nDataType=0x7\nDefaultValue=0x1\n[M1ModuleInfo]\n"
      "[M1Fixed2100]\nParameterName=f\nObjectType=8\nDataType=0x6\nCompactSubObj=2\n[M1Fixed2100Value]\n1=0xa\n"
      "[M1Fixed2101]\nParameterName=g\nObjectType=8\nDataType=0x5\n[M1Fixed2101sub1]\nDefaultValue=0xb\n"
      "[M1Fixed2102]\nParameterName=h\nDataType=0x0040\nDefaultValue=0xc\n");
  for (const char* part : {"[2100]\nParameterName=d\nDataType=0x0007\nDefaultValue=0x00000001\n",
                           "[M1Fixed2100Value]\n1=0x000A\n", "[M1Fixed2101sub1]\nDefaultValue=0x0B\n",
                           "[M1Fixed2102]\nParameterName=h\nDataType=0x0040\nDefaultValue=0xc\n"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << '\n' << text;
  }
}

TEST(OtherSections, FollowTheObjectsAndPrecedeUnknownSections) {
  const std::string text = form_of(
      "[Other]\n[M2SubExtX]\n[ConnectedModules]\n[M1ModuleInfo]\n[SupportedModules]\n[Tool1]\n[Tools]\n[DynamicChannels]\n[Comments]\n"
      "[M1Other]\n[ToolBox]\n");
  std::string titles;
  for (std::size_t at = text.find('['); at != std::string::npos; at = text.find('[', at + 1)) {
    titles += text.substr(at, text.find(']', at) + 1 - at);
  }
  EXPECT_EQ(titles,
            "[Comments][ManufacturerObjects][2000][DynamicChannels][Tools][Tool1][SupportedModules][M1ModuleInfo]"
            "[ConnectedModules][Other][M2SubExtX][M1Other][ToolBox]");
}

TEST(OtherSections, CountTheirLines) {
  expect_part("[comments]\nlines=7 ; lines\nline2=b ; c\nLINE1=a\nLine1=again\n",
              "[Comments]\n; lines\nLines=2\nLine1=a\nLine2=b ; c\n");
}

TEST(OtherSections, KeepTheNumberThatTheReaderReads) {
  expect_part("[Comments]\nLines=1\nLine010=ten\n", "[Comments]\nLines=1\nLine10=ten\n");
  expect_part("[Comments]\nLines=0\nLine0x10=none\n", "[Comments]\nLines=0\nLine0x10=none\n");
  expect_part("[Comments]\nLines=1\nLine2000000=far\n", "[Comments]\nLines=1\nLine2000000=far\n");
  expect_part("[DummyUsage]\nDummy0100=1\nDummy0005=1\n", "[DummyUsage]\nDummy0005=1\nDummy0100=1\n");
}

TEST(OtherSections, KeepAnOrderThatIsRead) {
  expect_part("[2000objectlinks]\n2=0x2002\nObjectLinks=9\n1=0x2001\n",
              "[2000ObjectLinks]\nObjectLinks=2\n2=0x2002\n1=0x2001\n");
  expect_part("[ConnectedModules]\n2=1\n1=0\nNrOfEntries=2\n", "[ConnectedModules]\nNrOfEntries=2\n2=1\n1=0\n");
}

TEST(OtherSections, KeepTheFirstOfTwoAndTheCommentsOfBoth) {
  for (const char* title : {"Tool1", "M1ModuleInfo", "M1SubExt6000", "M1Fixed2100sub1", "Tools", "DynamicChannels"}) {
    const std::string section = std::string{"["} + title + "]\n";
    const std::string text = form_of("; first\n" + section + "Name=a\n; second\n" + section + "; in second\nName=b\n");
    EXPECT_NE(text.find("; first\n; second\n; in second\n" + section), std::string::npos) << text;
    EXPECT_EQ(text.find("Name=b"), std::string::npos) << text;
  }
}

TEST(OtherSections, KeepUnknownKeysAndComments) {
  expect_part("[M1ModuleInfo]\n; about the colour\nColour=0X0a ; red\n; about the name\nproductname=A\n",
              "[M1ModuleInfo]\n; about the name\nProductName=A\n; about the colour\nColour=0X0a ; red\n");
  expect_part("[Tools]\n; about x\nx=y\nItems=0\n", "[Tools]\nItems=0\n; about x\nx=y\n");
}

TEST(CanonicalForm, KeepsCommentsAfterCountsAndAfterEntriesOfLists) {
  expect_part("[ManufacturerObjects]\nSupportedObjects=1 ; the number\n1=0x2000 ; the speed\n",
              "[ManufacturerObjects]\n; the number\nSupportedObjects=1\n; the speed\n1=0x2000\n");
  expect_part("[OptionalObjects]\nSupportedObjects=1 ; the number\n1=0x1008 # gone\n",
              "[OptionalObjects]\n; the number\n; gone\nSupportedObjects=0\n");
  expect_part("[2000Name]\nNrOfEntries=1 ; names\n1=x\n", "[2000Name]\n; names\nNrOfEntries=1\n1=x\n");
}

TEST(OtherSections, OfTheCanonicalFormAreTheSameDevice) {
  const std::vector<std::string> texts = {
      "[tool2]\ncommand=b ; c\n[TOOL1]\nname=a\n[tools]\nitems=5\n",
      "[Dynamicchannels]\ntype2=0x7 ; t\nrange2=0xa080-0xa081 ; r\ndir2=RWW ; d\nppoffset2=010\nType1=0\n",
      "[supportedmodules]\nnrofentries=1\n[m1moduleinfo]\nproductname=A ; a\nproductversion=0x2 ; b\n"
      "[m1subext6000]\ncount=0x02\nobjextend=0\nparametername=in\ndatatype=0x5\naccesstype=RO\npdomapping=1\n"
      "[m1fixed2100sub1]\ndatatype=0x6\nparametername=s\nDefaultValue=0xab ; c\n[m1fixed2100]\nparametername=f\n"
      "ObjectType=9\n[m1fixed2100SUB0]\ndatatype=5\nparametername=n\ndefaultvalue=1\n[m1comments]\nLine02=two\nline1=one\n"
      "[connectedmodules]\n2=0\n1=1\n",
      "[comments]\nline010=a\nline9=b ; c\n"};
  for (const std::string& text : texts) {
    const std::string once = form_of(text);
    EXPECT_EQ(Formatted(once).view(), Formatted(text + one_object).view()) << once;
    EXPECT_EQ(Formatted(once).text(), once);
  }
}

}  // namespace
}  // namespace edsc
