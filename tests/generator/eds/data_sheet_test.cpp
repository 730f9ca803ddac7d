#include "eds/data_sheet.hpp"

#include <gtest/gtest.h>

#include <string>

#include "support/diagnostic_matchers.hpp"
#include "text/source_file.hpp"

namespace edsc {
namespace {

struct ReadSheet {
  explicit ReadSheet(std::string text, std::string name = "test.eds")
      : source(std::move(name), std::move(text)), sheet(read_data_sheet(parse_ini(source, diagnostics), diagnostics)) {}

  SourceFile source;
  Diagnostics diagnostics;
  DataSheet sheet;
};

using Findings = std::vector<Finding>;

/// One listed object, so that only the text after it gives findings. Six lines.
const std::string one_object =
    "[OptionalObjects]\n"
    "SupportedObjects=1\n"
    "1=0x1005\n"
    "[1005]\n"
    "ParameterName=COB-ID SYNC\n"
    "DataType=0x0007\n";

TEST(DataSheet, PlacesTheKeysOfAnObject) {
  const ReadSheet read(
      one_object +
      "ObjectType=0x7\nAccessType=rw\nLowLimit=1\nHighLimit=9\nDefaultValue=0x80 ; sync\nPDOMapping=0\n"
      "ObjFlags=1\nParameterValue=5\nDenotation=mine\nUploadFile=a.bin\nDownloadFile=b.bin\nParamRefd=X1\n");
  EXPECT_EQ(findings(read.diagnostics), Findings{});
  ASSERT_EQ(read.sheet.objects.size(), 1U);
  const ObjectDescription& object = read.sheet.objects[0];
  EXPECT_EQ(object.index, 0x1005);
  EXPECT_TRUE(object.has_section);
  EXPECT_EQ(object.position.line, 4U);
  EXPECT_EQ(object.position.column, 2U);
  EXPECT_EQ(object.parameter_name.text, "COB-ID SYNC");
  EXPECT_EQ(object.data_type.text, "0x0007");
  EXPECT_EQ(object.object_type.text, "0x7");
  EXPECT_EQ(object.access_type.text, "rw");
  EXPECT_EQ(object.low_limit.text, "1");
  EXPECT_EQ(object.high_limit.text, "9");
  EXPECT_EQ(object.default_value.text, "0x80 ; sync");
  EXPECT_EQ(object.default_value.position.line, 11U);
  EXPECT_EQ(object.default_value.position.column, 14U);
  EXPECT_EQ(object.pdo_mapping.text, "0");
  EXPECT_EQ(object.obj_flags.text, "1");
  EXPECT_EQ(object.parameter_value.text, "5");
  EXPECT_EQ(object.denotation.text, "mine");
  EXPECT_EQ(object.upload_file.text, "a.bin");
  EXPECT_EQ(object.download_file.text, "b.bin");
}

TEST(DataSheet, PointsToTheSectionWhereAKeyIsMissing) {
  const ReadSheet read(one_object);
  const Field& missing = read.sheet.objects.at(0).access_type;
  EXPECT_FALSE(missing.present);
  EXPECT_EQ(missing.position.file, &read.source);
  EXPECT_EQ(missing.position.line, 4U);
}

TEST(DataSheet, TellsAnEmptyValueFromAMissingKey) {
  const ReadSheet read(one_object + "DefaultValue=\n");
  EXPECT_TRUE(read.sheet.objects.at(0).default_value.present);
  EXPECT_TRUE(read.sheet.objects.at(0).default_value.empty());
}

TEST(DataSheet, ReadsSectionAndKeyNamesInAnyLetterCase) {
  const ReadSheet read(
      "[OPTIONALOBJECTS]\nsupportedobjects=1\n1=0x1a00\n"
      "[1a00]\nparametername=x\nSUBNUMBER=1\n[1A00Sub0a]\nDATATYPE=5\n");
  EXPECT_EQ(findings(read.diagnostics), Findings{});
  const ObjectDescription& object = read.sheet.objects.at(0);
  EXPECT_EQ(object.index, 0x1A00);
  EXPECT_EQ(object.parameter_name.text, "x");
  EXPECT_EQ(object.sub_number.text, "1");
  EXPECT_EQ(object.sub_objects.at(0).sub_index, 0x0A);
  EXPECT_EQ(object.sub_objects.at(0).data_type.text, "5");
}

TEST(DataSheet, SortsObjectsAndSubObjects) {
  const ReadSheet read("[2000sub10]\n[2000sub2]\n[2000]\n[1005]\n[2000subFF]\n[2000sub0]\n");
  ASSERT_EQ(read.sheet.objects.size(), 2U);
  EXPECT_EQ(read.sheet.objects[0].index, 0x1005);
  EXPECT_EQ(read.sheet.objects[1].index, 0x2000);
  std::vector<int> sub_indices;
  for (const SubObjectDescription& sub_object : read.sheet.objects[1].sub_objects) {
    sub_indices.push_back(sub_object.sub_index);
  }
  EXPECT_EQ(sub_indices, (std::vector<int>{0x00, 0x02, 0x10, 0xFF}));
}

TEST(DataSheet, ReadsFileInfo) {
  const ReadSheet read(
      one_object +
      "[FileInfo]\nFileName=a.eds\nFileVersion=1\nFileRevision=2\nEDSVersion=4.0\nDescription=d\nCreatedBy=c\n"
      "CreationTime=09:00AM\nCreationDate=01-02-2020\nModificationTime=x\nModificationDate=y\nModifiedBy=z\n");
  EXPECT_EQ(findings(read.diagnostics), Findings{});
  EXPECT_EQ(read.sheet.file_info.file_name.text, "a.eds");
  EXPECT_EQ(read.sheet.file_info.file_version.text, "1");
  EXPECT_EQ(read.sheet.file_info.file_revision.text, "2");
  EXPECT_EQ(read.sheet.file_info.eds_version.text, "4.0");
  EXPECT_EQ(read.sheet.file_info.description.text, "d");
  EXPECT_EQ(read.sheet.file_info.created_by.text, "c");
}

TEST(DataSheet, ReadsDeviceInfoWithItsBaudRates) {
  const ReadSheet read(one_object + "[DeviceInfo]\nVendorNumber=0x1\nBaudRate_10=0\nbaudrate_1000=1\nNrOfRXPDO=4\n");
  EXPECT_EQ(findings(read.diagnostics), Findings{});
  const DeviceInfo& info = read.sheet.device_info;
  EXPECT_TRUE(info.present);
  EXPECT_EQ(info.position.line, 7U);
  EXPECT_EQ(info.vendor_number.text, "0x1");
  EXPECT_EQ(info.nr_of_rx_pdo.text, "4");
  EXPECT_FALSE(info.product_name.present);
  EXPECT_EQ(info.product_name.position.line, 7U);
  ASSERT_EQ(info.baud_rates.size(), 2U);
  EXPECT_EQ(info.baud_rates[0].kbit_per_second, 10);
  EXPECT_EQ(info.baud_rates[1].kbit_per_second, 1000);
  EXPECT_EQ(info.baud_rates[1].field.text, "1");
}

TEST(DataSheet, PointsToTheFileWhereASectionIsMissing) {
  const ReadSheet read(one_object);
  EXPECT_FALSE(read.sheet.device_info.present);
  EXPECT_EQ(read.sheet.device_info.vendor_name.position.file, &read.source);
  EXPECT_EQ(read.sheet.device_info.vendor_name.position.line, 0U);
}

TEST(DataSheet, ReadsDeviceCommissioningInBothSpellings) {
  for (const std::string name : {"DeviceComissioning", "DeviceCommissioning"}) {
    const ReadSheet read(one_object + "[" + name + "]\nNodeId=0x0A\nBaudRate=500\nNodeRefd=x\n");
    EXPECT_EQ(findings(read.diagnostics), Findings{});
    EXPECT_TRUE(read.sheet.commissioning.present);
    EXPECT_TRUE(read.sheet.is_dcf);
    EXPECT_EQ(read.sheet.commissioning.node_id.text, "0x0A");
    EXPECT_EQ(read.sheet.commissioning.baudrate.text, "500");
  }
}

TEST(DataSheet, KnowsADcfByItsNameToo) {
  EXPECT_FALSE(ReadSheet(one_object).sheet.is_dcf);
  EXPECT_TRUE(ReadSheet(one_object, "x.DCF").sheet.is_dcf);
}

TEST(DataSheet, ReadsDummyUsage) {
  const ReadSheet read(one_object + "[DummyUsage]\nDummy0005=1\nDummy001B=0\nDummy0100=1\nDummy5=1\n");
  EXPECT_EQ(findings(read.diagnostics), (Findings{warning_at(10, 1, "unknown-key"), warning_at(11, 1, "unknown-key")}));
  ASSERT_EQ(read.sheet.dummy_usage.size(), 2U);
  EXPECT_EQ(read.sheet.dummy_usage[0].number, 0x05U);
  EXPECT_EQ(read.sheet.dummy_usage[0].field.text, "1");
  EXPECT_EQ(read.sheet.dummy_usage[1].number, 0x1BU);
}

TEST(DataSheet, ReadsTheListsOfACompactForm) {
  const ReadSheet read(
      one_object +
      "CompactSubObj=3\n[1005Name]\nNrOfEntries=2\n1=One\n3=Three\n[1005value]\nNrOfEntries=1\n2=0x20\n"
      "[1005Denotation]\nNrOfEntries=1\n1=Mine\n");
  EXPECT_EQ(findings(read.diagnostics), Findings{});
  const ObjectDescription& object = read.sheet.objects.at(0);
  EXPECT_EQ(object.compact_sub_obj.text, "3");
  ASSERT_EQ(object.compact_names.size(), 2U);
  EXPECT_EQ(object.compact_names[1].number, 3U);
  EXPECT_EQ(object.compact_names[1].field.text, "Three");
  EXPECT_EQ(object.compact_values.at(0).field.text, "0x20");
  EXPECT_EQ(object.compact_denotations.at(0).field.text, "Mine");
}

TEST(DataSheet, WarnsOfAWrongNumberOfEntries) {
  const ReadSheet read(one_object + "[1005Name]\nNrOfEntries=2\n1=One\n");
  EXPECT_EQ(findings(read.diagnostics), (Findings{warning_at(8, 13, "entry-count")}));
}

TEST(DataSheet, ReportsAFileWithoutObjects) {
  EXPECT_EQ(findings(ReadSheet("[FileInfo]\n").diagnostics), (Findings{error_at(0, 0, "no-objects")}));
}

TEST(DataSheetErrors, NameAnEdsOfAnotherNetwork) {
  const ReadSheet read("[File]\nDescText = \"Drive EDS\";\n[Device]\nVendCode = 1;\nProdCode = 2;\n");
  EXPECT_EQ(messages(read.diagnostics).back(),
            "this is an EDS of EtherNet/IP, DeviceNet or ControlNet (ODVA), not of CANopen (CiA 306): it has no object "
            "section such as [1000]");
}

TEST(DataSheet, AddsNothingToWhatTheIniReaderReported) {
  EXPECT_EQ(findings(ReadSheet("").diagnostics), (Findings{error_at(0, 0, "empty-file")}));
}

TEST(DataSheet, ReadsTheSectionsOfEveryModule) {
  const ReadSheet read(one_object +
                       "[SupportedModules]\nNrOfEntries=12\n"
                       "[m12comments]\nLines=0\n[M12ModuleInfo]\nProductName=Twelve\n[M12Fixed2000]\nDataType=5\n"
                       "[M12Fixed2000Sub1]\nDataType=6\n[M12SubExt6000]\nCount=0;4\nObjExtend=8\nDataType=5\n");
  ASSERT_EQ(read.sheet.modules.supported.size(), 1U);
  const ModuleDescription& module = read.sheet.modules.supported[0];
  EXPECT_EQ(module.number, 12);
  EXPECT_EQ(module.position.line, 9U);
  EXPECT_EQ(module.product_name.text, "Twelve");
  EXPECT_TRUE(module.comments.present);
  ASSERT_EQ(module.objects.size(), 1U);
  EXPECT_EQ(module.objects[0].sub_objects.at(0).data_type.text, "6");
  ASSERT_EQ(module.sub_extensions.size(), 1U);
  EXPECT_EQ(module.sub_extensions[0].index, 0x6000);
  EXPECT_EQ(module.sub_extensions[0].count.text, "0;4") << "; is data here";
  EXPECT_EQ(module.sub_extensions[0].object_extend.text, "8");
  EXPECT_EQ(module.sub_extensions[0].data_type.text, "5");
}

TEST(DataSheet, WarnsOfSectionsOfAModuleThatStandTwice) {
  const ReadSheet read(
      one_object + "[SupportedModules]\nNrOfEntries=1\n[M1ModuleInfo]\nProductName=A\n[m1moduleinfo]\nProductName=B\n");
  EXPECT_EQ(findings(read.diagnostics), (Findings{warning_at(11, 2, "duplicate-section")}));
  EXPECT_EQ(read.sheet.modules.supported[0].product_name.text, "A");
}

TEST(DataSheet, WarnsOfUnknownKeysInEverySection) {
  for (const std::string name :
       {"Tools", "Tool1", "DynamicChannels", "SupportedModules", "ConnectedModules", "M1ModuleInfo", "M1Comments",
        "M1FixedObjects", "M1SubExtends", "M1SubExt6000", "1005ObjectLinks", "Comments"}) {
    const ReadSheet read(one_object + "[" + name + "]\nAnything=1\n");
    EXPECT_EQ(findings(read.diagnostics, "unknown-key"), (Findings{warning_at(8, 1, "unknown-key")})) << name;
  }
}

TEST(DataSheet, WarnsOfUnknownSections) {
  for (const std::string name : {"", "PreDefines", "Toolbox", "ModuleInfo", "1005Names", "MModuleInfo", "M1", "M1Fixed",
                                 "M1Other", "Tool", "Tool1a"}) {
    const ReadSheet read(one_object + "[" + name + "]\nAnything=1\n");
    EXPECT_EQ(findings(read.diagnostics), (Findings{warning_at(7, 2, "unknown-section")})) << name;
  }
}

TEST(DataSheet, WarnsOfAShortIndex) {
  const ReadSheet read(one_object + "[40]\n[40sub1]\n");
  EXPECT_EQ(findings(read.diagnostics, "section-name"), (Findings{warning_at(7, 2, "section-name")}));
  EXPECT_EQ(read.diagnostics.all().at(0).places, 2U);
  EXPECT_EQ(read.sheet.objects.at(0).index, 0x40);
  EXPECT_EQ(read.sheet.objects.at(0).sub_objects.size(), 1U);
}

TEST(DataSheet, ReadsAnIndexWithAPrefix) {
  const ReadSheet read(one_object + "[0x2000]\nParameterName=a\n[0X2001sub1]\nParameterName=b\n");
  EXPECT_EQ(findings(read.diagnostics, "section-name"), (Findings{warning_at(7, 2, "section-name")}));
  ASSERT_EQ(read.sheet.objects.size(), 3U);
  EXPECT_EQ(read.sheet.objects.at(1).parameter_name.text, "a");
  EXPECT_EQ(read.sheet.objects.at(2).sub_objects.at(0).parameter_name.text, "b");
}

TEST(DataSheet, ReadsNumbersAndAccessTypesInQuotationMarks) {
  const ReadSheet read("[2000]\nParameterName=\"a\"\nDataType=\"0x0005\"\nAccessType=\"ro\"\nPDOMapping=\"1\"\n");
  EXPECT_EQ(findings(read.diagnostics, "number-spelling"), (Findings{warning_at(3, 10, "number-spelling")}));
  EXPECT_EQ(read.diagnostics.all().at(0).places, 3U);
  const ObjectDescription& object = read.sheet.objects.at(0);
  EXPECT_EQ(object.parameter_name.text, "\"a\"") << "part of the text";
  EXPECT_EQ(object.data_type.text, "0x0005");
  EXPECT_EQ(object.access_type.text, "ro");
  EXPECT_EQ(object.pdo_mapping.text, "1");
}

TEST(DataSheet, ReadsAnIndexOfAListInTheNotationOfManuals) {
  const ReadSheet read(one_object + "[ManufacturerObjects]\nSupportedObjects=1\n1=2000h\n");
  EXPECT_EQ(findings(read.diagnostics, "number-spelling"), (Findings{warning_at(9, 3, "number-spelling")}));
  EXPECT_EQ(read.sheet.listed.back().index, 0x2000);
}

TEST(DataSheet, IgnoresNulBytesAtTheEnd) {
  EXPECT_EQ(findings(ReadSheet(one_object + std::string(3, '\0')).diagnostics), Findings{});
  EXPECT_EQ(findings(ReadSheet(one_object + std::string(1, '\0') + "a=1\n").diagnostics),
            (Findings{error_at(7, 1, "binary-file")}));
}

TEST(DataSheet, TakesASubIndexOfOneOrTwoDigits) {
  const ReadSheet read(one_object + "[1005sub0]\n[1005sub01]\n[1005sub2]\n");
  EXPECT_EQ(findings(read.diagnostics), Findings{});
  EXPECT_EQ(read.sheet.objects.at(0).sub_objects.size(), 3U);
}

TEST(DataSheet, RefusesNamesThatAreNoIndexOrSubIndex) {
  for (const std::string name : {"10000", "10000sub1", "1005sub", "1005sub100", "1005sub001", "1005subG", "1005sub1x",
                                 "1005_1", "1005.1", "1005 sub0", "1005-01", "0x10000"}) {
    const ReadSheet read(one_object + "[" + name + "]\n");
    EXPECT_EQ(findings(read.diagnostics), (Findings{error_at(7, 2, "section-name")})) << name;
  }
}

TEST(DataSheet, WarnsOfUnknownKeys) {
  const ReadSheet read(one_object +
                       "Colour=red\n[1005sub1]\nSubNumber=1\n[DeviceInfo]\nBaudRate_fast=1\n[FileInfo]\nCustomer=x\n");
  EXPECT_EQ(findings(read.diagnostics), (Findings{warning_at(13, 1, "unknown-key"), warning_at(11, 1, "unknown-key"),
                                                  warning_at(7, 1, "unknown-key"), warning_at(9, 1, "unknown-key")}));
}

TEST(DataSheet, TakesTheFirstOfTwoKeys) {
  const ReadSheet read(one_object + "AccessType=ro\naccesstype=rw\n");
  EXPECT_EQ(findings(read.diagnostics), (Findings{warning_at(8, 1, "duplicate-key")}));
  ASSERT_EQ(read.diagnostics.all()[0].notes.size(), 1U);
  EXPECT_EQ(read.diagnostics.all()[0].notes[0].position.line, 7U);
  EXPECT_EQ(read.sheet.objects.at(0).access_type.text, "ro");
}

TEST(DataSheet, TakesTheFirstOfTwoSections) {
  const ReadSheet read(one_object + "[1005]\nParameterName=Other\n");
  EXPECT_EQ(findings(read.diagnostics), (Findings{warning_at(7, 2, "duplicate-section")}));
  const Diagnostic& diagnostic = read.diagnostics.all()[0];
  EXPECT_NE(diagnostic.message.find("different content"), std::string::npos);
  ASSERT_EQ(diagnostic.notes.size(), 1U);
  EXPECT_EQ(diagnostic.notes[0].position.line, 4U);
  ASSERT_EQ(read.sheet.objects.size(), 1U);
  EXPECT_EQ(read.sheet.objects[0].parameter_name.text, "COB-ID SYNC");
}

TEST(DataSheet, SaysWhenTheSecondSectionIsTheSame) {
  const ReadSheet read(one_object + "[1005sub1]\nDataType=5\n[1005SUB01]\ndatatype=5\n[FileInfo]\n[fileinfo]\n");
  EXPECT_EQ(findings(read.diagnostics), (Findings{warning_at(12, 2, "duplicate-section")}));
  const Diagnostic& finding = read.diagnostics.all()[0];
  EXPECT_EQ(finding.places, 2U);
  EXPECT_NE(finding.message.find("the same content"), std::string::npos);
  EXPECT_EQ(finding.notes.back().position.line, 9U);
}

TEST(DataSheet, MakesTheObjectOfSubObjectsThatHaveNone) {
  const ReadSheet read("[ManufacturerObjects]\nSupportedObjects=1\n1=0x2022\n[2022sub0]\n[2022sub1]\n");
  EXPECT_EQ(findings(read.diagnostics), (Findings{warning_at(4, 2, "sub-object-without-object")}));
  ASSERT_EQ(read.sheet.objects.size(), 1U);
  EXPECT_FALSE(read.sheet.objects[0].has_section);
  EXPECT_EQ(read.sheet.objects[0].position.line, 4U);
  EXPECT_EQ(read.sheet.objects[0].sub_objects.size(), 2U);
}

TEST(ObjectLists, KeepTheirOrderAndPlaces) {
  const ReadSheet read(
      "[OptionalObjects]\nSupportedObjects=0x2\n1=0x1017 ; heartbeat\n2=4101\n[MandatoryObjects]\nSupportedObjects=1\n"
      "1= 0x1000\n[1000]\n[1005]\n[1017]\n");
  EXPECT_EQ(findings(read.diagnostics), Findings{});
  ASSERT_EQ(read.sheet.listed.size(), 3U);
  EXPECT_EQ(read.sheet.listed[0].list, ObjectListKind::mandatory);
  EXPECT_EQ(read.sheet.listed[0].index, 0x1000);
  EXPECT_EQ(read.sheet.listed[1].list, ObjectListKind::optional);
  EXPECT_EQ(read.sheet.listed[1].index, 0x1017);
  EXPECT_EQ(read.sheet.listed[2].index, 0x1005);
  EXPECT_EQ(read.sheet.listed[2].position.line, 4U);
  EXPECT_EQ(read.sheet.listed[2].position.column, 3U);
}

TEST(ObjectLists, RefuseWhatIsNoIndex) {
  const ReadSheet read("[OptionalObjects]\nSupportedObjects=x\n1=heartbeat\n2=0x10000\n3=\n4=0\n5=0x1005\n[1005]\n");
  EXPECT_EQ(findings(read.diagnostics),
            (Findings{error_at(2, 18, "number"), error_at(3, 3, "number"), error_at(4, 3, "number"),
                      error_at(5, 3, "number"), error_at(6, 3, "number")}));
  EXPECT_EQ(read.sheet.listed.size(), 1U);
}

TEST(ObjectLists, AreCounted) {
  EXPECT_EQ(findings(ReadSheet("[OptionalObjects]\nSupportedObjects=2\n1=0x1005\n[1005]\n").diagnostics),
            (Findings{warning_at(2, 18, "object-list-count")}));
  EXPECT_EQ(findings(ReadSheet("[OptionalObjects]\n1=0x1005\n[1005]\n").diagnostics),
            (Findings{warning_at(1, 2, "object-list-count")}));
  EXPECT_EQ(findings(ReadSheet("[OptionalObjects]\nSupportedObjects=1\n2=0x1005\n[1005]\n").diagnostics),
            (Findings{warning_at(3, 1, "object-list-count")}));
}

TEST(ObjectLists, TakeABlankInSupportedObjects) {
  const ReadSheet read("[OptionalObjects]\nSupported Objects=1\n1=0x1005\n[1005]\n");
  EXPECT_EQ(findings(read.diagnostics), (Findings{warning_at(2, 1, "key-spelling")}));
}

TEST(ObjectLists, HaveNoOtherKeys) {
  const ReadSheet read("[OptionalObjects]\nSupportedObjects=1\n1=0x1005\nx=1\n[1005]\n");
  EXPECT_EQ(findings(read.diagnostics), (Findings{warning_at(4, 1, "unknown-key")}));
}

TEST(ObjectLists, TakeTheFirstOfTwoNumbers) {
  const ReadSheet read("[OptionalObjects]\nSupportedObjects=1\n1=0x1005\n01=0x1006\n[1005]\n");
  EXPECT_EQ(findings(read.diagnostics), (Findings{warning_at(4, 1, "duplicate-key")}));
  EXPECT_EQ(read.diagnostics.all()[0].notes.at(0).position.line, 3U);
}

TEST(ObjectLists, HoldAnObjectOnce) {
  const ReadSheet read(
      "[MandatoryObjects]\nSupportedObjects=1\n1=0x1001\n[OptionalObjects]\nSupportedObjects=1\n1=0x1001\n[1001]\n");
  EXPECT_EQ(findings(read.diagnostics), (Findings{warning_at(6, 3, "object-list")}));
  EXPECT_EQ(read.diagnostics.all()[0].notes.at(0).position.line, 3U);
  EXPECT_EQ(read.sheet.listed.size(), 1U);
}

struct ListCase {
  const char* list;
  const char* index;
  bool is_right;
};

class ListOfAnObject : public testing::TestWithParam<ListCase> {};

TEST_P(ListOfAnObject, IsGivenByItsIndex) {
  const std::string index = GetParam().index;
  const ReadSheet read("[" + std::string(GetParam().list) + "]\nSupportedObjects=1\n1=0x" + index + "\n[" + index +
                       "]\n");
  const Findings wrong{warning_at(3, 3, "object-list")};
  EXPECT_EQ(findings(read.diagnostics), GetParam().is_right ? Findings{} : wrong);
}

INSTANTIATE_TEST_SUITE_P(
    Indices, ListOfAnObject,
    testing::Values(ListCase{"MandatoryObjects", "1000", true}, ListCase{"MandatoryObjects", "1001", true},
                    ListCase{"MandatoryObjects", "1018", true}, ListCase{"MandatoryObjects", "1003", false},
                    ListCase{"MandatoryObjects", "2000", false}, ListCase{"OptionalObjects", "1003", true},
                    ListCase{"OptionalObjects", "1FFF", true}, ListCase{"OptionalObjects", "6000", true},
                    ListCase{"OptionalObjects", "FFFF", true}, ListCase{"OptionalObjects", "1018", false},
                    ListCase{"OptionalObjects", "2000", false}, ListCase{"ManufacturerObjects", "2000", true},
                    ListCase{"ManufacturerObjects", "5FFF", true}, ListCase{"ManufacturerObjects", "1000", false},
                    ListCase{"ManufacturerObjects", "6000", false}, ListCase{"ManufacturerObjects", "FFFF", false},
                    ListCase{"OptionalObjects", "0040", true}, ListCase{"ManufacturerObjects", "0040", true}));

TEST(ObjectLists, WarnOfAnObjectWithoutSection) {
  const ReadSheet read("[OptionalObjects]\nSupportedObjects=2\n1=0x1005\n2=0x1006\n[1005]\n");
  EXPECT_EQ(findings(read.diagnostics), (Findings{warning_at(4, 3, "object-without-section")}));
}

TEST(ObjectLists, WarnOfASectionInNoList) {
  const ReadSheet read(one_object + "[1006]\n");
  EXPECT_EQ(findings(read.diagnostics), (Findings{warning_at(7, 2, "object-not-listed")}));
}

}  // namespace
}  // namespace edsc
