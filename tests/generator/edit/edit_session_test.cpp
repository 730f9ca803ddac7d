// A file that is edited: steps, undo and redo, journal, changes of the file by others, overlays. The expected texts are
// written by hand.
#include "edit/edit_session.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "system/temporary_folder.hpp"

namespace edsc::edit {
namespace {

constexpr const char* small_eds =
    "[FileInfo]\r\nFileName=a.eds\r\n[DeviceInfo]\r\nVendorNumber=0x1\r\nRevisionNumber=0x00010000\r\n"
    "[MandatoryObjects]\r\nSupportedObjects=3\r\n1=0x1000\r\n2=0x1001\r\n3=0x1018\r\n"
    "[1000]\r\nParameterName=Device type\r\nObjectType=7\r\nDataType=0x0007\r\nAccessType=ro\r\nDefaultValue=0\r\n"
    "[1001]\r\nParameterName=Error register\r\nObjectType=7\r\nDataType=5\r\nAccessType=ro\r\n"
    "[1018]\r\nParameterName=Identity\r\nObjectType=9\r\nSubNumber=2\r\n"
    "[1018sub0]\r\nParameterName=Highest sub-index\r\nDataType=5\r\nAccessType=ro\r\nDefaultValue=1\r\n"
    "[1018sub1]\r\nParameterName=Vendor-ID\r\nDataType=7\r\nAccessType=ro\r\nDefaultValue=1 ; of CiA\r\n"
    "[ManufacturerObjects]\r\nSupportedObjects=1\r\n1=0x2000\r\n"
    "[2000]\r\nParameterName=Speed\r\nObjectType=7\r\nDataType=0x0006\r\nAccessType=rww\r\nDefaultValue=0x0010\r\n"
    "PDOMapping=1\r\n";

const std::string small_overlay =
    "[Overlay]\nVersion=1\nBase=a.eds\n; the manual, page 8\n[1000]\nDefaultValue=0 => 0x191\n";

std::string replaced(std::string text, const std::string& old_text, const std::string& new_text) {
  const std::size_t at = text.find(old_text);
  EXPECT_NE(at, std::string::npos) << old_text;
  return at == std::string::npos ? text : text.replace(at, old_text.size(), new_text);
}

class EditSessionTest : public ::testing::Test {
 protected:
  void write(const std::string& name, const std::string& bytes) const {
    std::ofstream{path(name), std::ios::binary} << bytes;
  }
  [[nodiscard]] std::string read(const std::string& name) const {
    std::ostringstream text;
    text << std::ifstream{path(name), std::ios::binary}.rdbuf();
    return text.str();
  }
  [[nodiscard]] std::string path(const std::string& name) const { return folder_.path() + "/" + name; }

  [[nodiscard]] EditSession open(const std::string& name = "a.eds") const {
    return EditSession{{path(name), {}, path("journal"), {}}};
  }

  static nlohmann::json post(EditSession& session, const std::string& action, const nlohmann::json& request = {}) {
    const EditAnswer answer = session.post(action, request.is_null() ? "{}" : request.dump());
    EXPECT_EQ(answer.status, 200) << answer.body;
    return nlohmann::json::parse(answer.body);
  }
  static nlohmann::json change(EditSession& session, const std::vector<nlohmann::json>& changes) {
    return post(session, "change", {{"since", session.version()}, {"changes", changes}});
  }
  static nlohmann::json set(const std::string& section, const std::string& key, const std::string& value) {
    return {{"do", "set"}, {"section", section}, {"key", key}, {"value", value}};
  }
  static nlohmann::json part(const EditSession& session, const std::string& name) {
    return nlohmann::json::parse(session.update(0)).at("parts").at(name);
  }

  TemporaryFolder folder_{"edit"};
};

TEST_F(EditSessionTest, ChangesOneLineAndUndoesIt) {
  write("a.eds", small_eds);
  EditSession session = open();
  ASSERT_EQ(session.problem(), "");
  const auto answer = change(session, {set("2000", "DefaultValue", "64h")});
  const std::string expected = replaced(small_eds, "DefaultValue=0x0010", "DefaultValue=0x0064");
  EXPECT_EQ(session.bytes(), expected);
  EXPECT_EQ(read("a.eds"), small_eds);
  EXPECT_TRUE(answer.at("parts").contains("object/2000"));
  EXPECT_FALSE(answer.at("parts").contains("object/1018"));
  EXPECT_EQ(answer["parts"]["status"]["undo"], "set DefaultValue of 2000h to 64h");
  post(session, "undo");
  EXPECT_EQ(session.bytes(), small_eds);
  EXPECT_FALSE(session.has_unsaved_edits());
  EXPECT_EQ(part(session, "status")["redo"], "set DefaultValue of 2000h to 64h");
  post(session, "redo");
  EXPECT_EQ(session.bytes(), expected);
  post(session, "save");
  EXPECT_EQ(read("a.eds"), expected);
  post(session, "undo");
  EXPECT_TRUE(session.has_unsaved_edits());
  EXPECT_EQ(session.bytes(), small_eds);
}

TEST_F(EditSessionTest, SeveralChangesAreOneStep) {
  write("a.eds", small_eds);
  EditSession session = open();
  change(session, {set("2000", "LowLimit", "1"), set("2000", "HighLimit", "0x20"), set("2000", "ParameterName", "")});
  EXPECT_NE(session.bytes().find("LowLimit=1\r\nHighLimit=0x20\r\n"), std::string::npos) << session.bytes();
  EXPECT_EQ(session.bytes().find("Speed"), std::string::npos);
  post(session, "undo");
  EXPECT_EQ(session.bytes(), small_eds);
}

TEST_F(EditSessionTest, RejectsWhatAddsAnError) {
  write("a.eds", small_eds);
  EditSession session = open();
  const std::vector<nlohmann::json> changes{set("2000", "LowLimit", "1"), set("2000", "DefaultValue", "70000")};
  const auto answer = change(session, changes);
  ASSERT_TRUE(answer.contains("rejected")) << answer;
  EXPECT_EQ(answer["rejected"]["index"], 1);
  EXPECT_TRUE(answer["rejected"]["can_force"].get<bool>());
  EXPECT_FALSE(answer["rejected"]["findings"].empty());
  EXPECT_EQ(session.bytes(), small_eds);
  post(session, "change", {{"changes", changes}, {"force", true}});
  EXPECT_NE(session.bytes().find("DefaultValue=0x11170\r\n"), std::string::npos);
}

TEST_F(EditSessionTest, MapsAPdo) {
  write("a.eds", small_eds);
  EditSession session = open();
  const nlohmann::json rpdo = {{"do", "pdo"},   {"direction", "rpdo"},
                               {"number", 1},   {"entries", {"20000010h"}},
                               {"type", "255"}, {"cob_id", {{"kind", "predefined"}}}};
  const auto answer = change(session, {rpdo});
  ASSERT_FALSE(answer.contains("rejected")) << answer;
  const auto pdo = part(session, "pdos")["list"][0];
  EXPECT_EQ(pdo["id"], "rpdo1");
  EXPECT_EQ(pdo["cob_id"]["kind"], "predefined");
  EXPECT_EQ(pdo["cob_id"]["text"], "$NODEID+0x200");
  EXPECT_EQ(pdo["entries"][0]["label"], "byte 0 to 1, Speed");
  EXPECT_EQ(pdo["free_bits"], 48);
  EXPECT_EQ(part(session, "object/2000")["mapped_by"], nlohmann::json::array({"RPDO 1"}));
  EXPECT_EQ(part(session, "candidates/rpdo")["list"][0]["raw"], "20000010h");
  EXPECT_TRUE(part(session, "candidates/tpdo")["list"].empty());
  const auto removal = change(session, {{{"do", "remove"}, {"section", "2000"}}});
  EXPECT_TRUE(removal.contains("rejected"));
  for (const char* wrong : {"5ms", "-1", "70000"}) {
    const auto rejected = change(session, {{{"do", "pdo"}, {"direction", "rpdo"}, {"number", 1}, {"event_ms", wrong}}});
    EXPECT_TRUE(rejected.contains("rejected")) << wrong;
  }
}

TEST_F(EditSessionTest, AddsObjects) {
  write("a.eds", small_eds);
  EditSession session = open();
  change(session, {{{"do", "new"}, {"kind", "standard"}, {"objects", {"1017"}}}});
  change(session, {{{"do", "new"},
                    {"kind", "ARRAY"},
                    {"index", "2010h"},
                    {"name", "Gains"},
                    {"type", "UNSIGNED16"},
                    {"access", "rw"},
                    {"elements", 2}}});
  change(session, {{{"do", "new"}, {"kind", "copy"}, {"from", "2000"}, {"to", {"2020"}}}});
  EXPECT_EQ(part(session, "object/1017")["name"], "Producer heartbeat time");
  EXPECT_EQ(part(session, "object/2010")["entries"].size(), 4U);
  EXPECT_EQ(part(session, "object/2020")["name"], "Speed");
  EXPECT_NE(session.bytes().find("SupportedObjects=3\r\n1=0x2000\r\n2=0x2010\r\n3=0x2020\r\n"), std::string::npos);
  for (int i = 0; i < 3; ++i) post(session, "undo");
  EXPECT_EQ(session.bytes(), small_eds);
}

TEST_F(EditSessionTest, RemovedObjectsAreNamed) {
  write("a.eds", small_eds);
  EditSession session = open();
  const auto answer = change(session, {{{"do", "remove"}, {"section", "2000"}}});
  EXPECT_EQ(answer["removed"], nlohmann::json::array({"object/2000"}));
  const auto undone = post(session, "undo", {{"since", answer["version"]}});
  EXPECT_TRUE(undone["removed"].empty());
  EXPECT_TRUE(undone["parts"].contains("object/2000"));
}

TEST_F(EditSessionTest, RaisesTheMajorRevision) {
  write("a.eds", small_eds);
  EditSession session = open();
  change(session, {set("2000", "DefaultValue", "17")});
  const auto review = post(session, "review");
  EXPECT_NE(review["diff"].get<std::string>().find("+DefaultValue=0x0011"), std::string::npos) << review["diff"];
  EXPECT_TRUE(review["can_raise_revision"].get<bool>());
  post(session, "save", {{"raise_revision", true}});
  EXPECT_NE(read("a.eds").find("RevisionNumber=0x00020000\r\n"), std::string::npos);
}

TEST_F(EditSessionTest, JournalOffersUnsavedEdits) {
  write("a.eds", small_eds);
  std::string edited;
  {
    EditSession session = open();
    change(session, {set("2000", "DefaultValue", "17")});
    change(session, {set("2000", "HighLimit", "100")});
    post(session, "undo");
    edited = session.bytes();
  }
  for (const auto& file : std::filesystem::directory_iterator{path("journal")}) {
    struct stat state {};
    ASSERT_EQ(::stat(file.path().c_str(), &state), 0);
    EXPECT_EQ(state.st_mode & 0777U, 0600U);
  }
  EditSession session = open();
  EXPECT_EQ(part(session, "status")["journal"]["edits"], 3);
  EXPECT_TRUE(change(session, {set("2000", "DefaultValue", "18")}).contains("rejected"));
  post(session, "journal", {{"use", true}});
  EXPECT_EQ(session.bytes(), edited);
  EXPECT_EQ(part(session, "status")["journal"], nullptr);
  for (int i = 0; i < 3; ++i) post(session, "undo");
  EXPECT_EQ(session.bytes(), small_eds);
}

TEST_F(EditSessionTest, JournalCanBeDiscarded) {
  write("a.eds", small_eds);
  {
    EditSession session = open();
    change(session, {set("2000", "DefaultValue", "17")});
  }
  {
    EditSession session = open();
    post(session, "journal", {{"use", false}});
    EXPECT_EQ(session.bytes(), small_eds);
  }
  EditSession session = open();
  EXPECT_EQ(part(session, "status")["journal"], nullptr);
}

TEST_F(EditSessionTest, FindingIsAllowedWithAReason) {
  write("a.eds", replaced(small_eds, "RevisionNumber=0x00010000", "VendorNme=x"));
  EditSession session = open();
  const auto finding = [&]() -> nlohmann::json {
    const nlohmann::json findings = part(session, "findings");
    for (const auto& one : findings["list"]) {
      if (one["rule"] == "unknown-key") return one;
    }
    return nullptr;
  };
  const nlohmann::json before = finding();
  ASSERT_FALSE(before.is_null());
  nlohmann::json allow = before["fixes"].back();
  EXPECT_EQ(allow["needs_reason"], true);
  EXPECT_TRUE(change(session, {allow["changes"][0]}).contains("rejected"));
  allow["changes"][0]["reason"] = "the tool of the vendor needs it";
  change(session, {allow["changes"][0]});
  EXPECT_EQ(session.bytes(), replaced(small_eds, "RevisionNumber=0x00010000",
                                      "; edsc: allow unknown-key - the tool of the vendor needs it\r\nVendorNme=x"));
  EXPECT_TRUE(finding().is_null());
}

TEST_F(EditSessionTest, IncompleteRecordIsNotUsed) {
  write("a.eds", small_eds);
  std::string edited;
  {
    EditSession session = open();
    change(session, {set("2000", "DefaultValue", "17")});
    edited = session.bytes();
  }
  for (const auto& file : std::filesystem::directory_iterator{path("journal")}) {
    std::ofstream{file.path(), std::ios::app} << R"({"step":"set","edits":[[0,"[Fi)";
  }
  EditSession session = open();
  post(session, "journal", {{"use", true}});
  EXPECT_EQ(session.bytes(), edited);
}

TEST_F(EditSessionTest, NoStepIsLostWhileTheJournalBeginsAgain) {
  write("a.eds", small_eds);
  std::string edited;
  {
    EditSession session = open();
    change(session, {set("2000", "DefaultValue", "17")});
    change(session, {set("2000", "HighLimit", "100")});
    edited = session.bytes();
  }
  const std::string journal = "journal/" + std::filesystem::directory_iterator {
    path("journal")
    } -> path().filename().string();
  const std::string before = read(journal);
  {
    EditSession session = open();
    post(session, "journal", {{"use", true}});
  }
  const std::string after = read(journal);
  ASSERT_TRUE(after.starts_with(before));
  ASSERT_GT(after.size(), before.size());
  for (std::size_t written = before.size(); written <= after.size(); written += 7) {
    write(journal, after.substr(0, written));
    EditSession session = open();
    post(session, "journal", {{"use", true}});
    ASSERT_EQ(session.bytes(), edited) << written << " bytes written";
  }
}

TEST_F(EditSessionTest, SaveOverwritesNothingIntoWhichEditsCannotBeMerged) {
  write("a.eds", small_eds);
  EditSession session = open();
  change(session, {set("2000", "DefaultValue", "17")});
  const std::string theirs = "<?xml version=\"1.0\"?><ISO15745ProfileContainer/>";
  write("a.eds", theirs);
  EXPECT_TRUE(post(session, "save").contains("rejected"));
  EXPECT_EQ(read("a.eds"), theirs);
  EXPECT_TRUE(session.has_unsaved_edits());
}

TEST_F(EditSessionTest, OneSessionAtATime) {
  write("a.eds", small_eds);
  const EditSession first = open();
  const EditSession second = open();
  EXPECT_NE(second.problem().find("another edsc edit"), std::string::npos);
}

TEST_F(EditSessionTest, EditsOfOtherLinesRemain) {
  write("a.eds", small_eds);
  EditSession session = open();
  change(session, {set("2000", "DefaultValue", "17")});
  const std::string theirs = replaced(small_eds, "ParameterName=Error register", "; new\r\nParameterName=Errors");
  write("a.eds", theirs);
  EXPECT_TRUE(session.look_at_disk());
  EXPECT_EQ(session.bytes(), replaced(theirs, "0x0010", "0x0011"));
  EXPECT_TRUE(part(session, "status")["conflicts"].empty());
  post(session, "undo");
  EXPECT_EQ(session.bytes(), theirs);
  EXPECT_EQ(read("a.eds"), theirs);
}

TEST_F(EditSessionTest, SameLineIsAConflict) {
  for (const std::string keep : {"mine", "theirs"}) {
    write("a.eds", small_eds);
    EditSession session = open();
    change(session, {set("2000", "DefaultValue", "17")});
    const std::string theirs = replaced(small_eds, "DefaultValue=0x0010", "DefaultValue=0x0020");
    write("a.eds", theirs);
    EXPECT_TRUE(post(session, "save").contains("rejected"));
    EXPECT_EQ(read("a.eds"), theirs);
    const auto conflicts = part(session, "status")["conflicts"];
    ASSERT_EQ(conflicts.size(), 1U);
    EXPECT_EQ(conflicts[0]["mine"], nlohmann::json::array({"DefaultValue=0x0011"}));
    EXPECT_EQ(conflicts[0]["theirs"], nlohmann::json::array({"DefaultValue=0x0020"}));
    EXPECT_TRUE(change(session, {set("2000", "HighLimit", "100")}).contains("rejected"));
    post(session, "resolve", {{"id", conflicts[0]["id"]}, {"keep", keep}});
    EXPECT_EQ(session.bytes(), keep == "mine" ? replaced(theirs, "0x0020", "0x0011") : theirs);
    post(session, "save");
    EXPECT_EQ(read("a.eds"), session.bytes());
  }
}

TEST_F(EditSessionTest, EditsRemainWhileTheFileIsWrittenInParts) {
  write("a.eds", small_eds);
  EditSession session = open();
  change(session, {set("2000", "DefaultValue", "17")});
  const std::string theirs = replaced(small_eds, "ParameterName=Error register", "ParameterName=Errors");
  for (const std::size_t written : {std::size_t{0}, theirs.find("[2000]"), theirs.size()}) {
    write("a.eds", theirs.substr(0, written));
    EXPECT_TRUE(session.look_at_disk());
  }
  EXPECT_TRUE(part(session, "status")["conflicts"].empty());
  EXPECT_EQ(session.bytes(), replaced(theirs, "0x0010", "0x0011"));
}

TEST_F(EditSessionTest, KeepsUnreadableLines) {
  const std::string bytes = replaced(small_eds, "[2000]\r\n", "what is this\r\n[2000]\r\n");
  write("a.eds", bytes);
  EditSession session = open();
  ASSERT_EQ(session.problem(), "");
  const auto unreadable = part(session, "status")["unreadable"];
  ASSERT_EQ(unreadable.size(), 1U);
  EXPECT_EQ(unreadable[0]["text"], "what is this");
  change(session, {set("2000", "DefaultValue", "17")});
  EXPECT_EQ(session.bytes(), replaced(bytes, "0x0010", "0x0011"));
}

TEST_F(EditSessionTest, FixesOfFindingsAreChanges) {
  write("a.eds", replaced(small_eds, "SupportedObjects=1", "SupportedObjects=7"));
  EditSession session = open();
  bool is_fixed = false;
  const nlohmann::json findings = part(session, "findings")["list"];
  for (const nlohmann::json& finding : findings) {
    if (finding["rule"] != "object-list-count") continue;
    EXPECT_EQ(finding["section"], "ManufacturerObjects");
    ASSERT_FALSE(finding["fixes"].empty()) << finding;
    EXPECT_FALSE(change(session, finding["fixes"][0]["changes"]).contains("rejected"));
    is_fixed = true;
    break;
  }
  EXPECT_TRUE(is_fixed);
  EXPECT_EQ(session.bytes(), small_eds);
}

TEST_F(EditSessionTest, ChangesOfAnOverlayAreWrittenToIt) {
  write("a.eds", small_eds);
  write("b.overlay", small_overlay);
  EditSession session = open("b.overlay");
  ASSERT_EQ(session.problem(), "");
  EXPECT_EQ(part(session, "file")["kind"], "overlay");
  EXPECT_TRUE(part(session, "object/2000")["entries"][0]["from_base"].get<bool>());
  EXPECT_FALSE(part(session, "object/1000")["entries"][0]["from_base"].get<bool>());
  const auto answer = change(session, {set("2000", "DefaultValue", "17")});
  ASSERT_FALSE(answer.contains("rejected")) << answer;
  EXPECT_EQ(session.bytes(), small_overlay + "\n[2000]\nDefaultValue=0x0010 => 0x0011\n");
  change(session, {set("2000", "DefaultValue", "18")});
  EXPECT_EQ(session.bytes(), small_overlay + "\n[2000]\nDefaultValue=0x0010 => 0x0012\n");
  post(session, "undo");
  post(session, "undo");
  EXPECT_EQ(session.bytes(), small_overlay);
  change(session, {set("1000", "DefaultValue", "0")});
  EXPECT_EQ(session.bytes().find("[1000]"), std::string::npos) << session.bytes();
  EXPECT_EQ(read("a.eds"), small_eds);
}

TEST_F(EditSessionTest, AnOverlayDoesNotAllowFindings) {
  write("a.eds", small_eds);
  write("b.overlay", small_overlay);
  EditSession session = open("b.overlay");
  const auto findings = part(session, "findings")["list"];
  ASSERT_FALSE(findings.empty());
  for (const auto& finding : findings) {
    for (const auto& fix : finding["fixes"]) EXPECT_FALSE(fix["needs_reason"].get<bool>()) << finding;
  }
  const auto answer =
      change(session, {{{"do", "allow"}, {"section", "2000"}, {"rule", "unknown-key"}, {"reason", "as delivered"}}});
  ASSERT_TRUE(answer.contains("rejected")) << answer;
  EXPECT_NE(answer["rejected"]["message"].get<std::string>().find("options file"), std::string::npos) << answer;
  EXPECT_EQ(session.bytes(), small_overlay);
}

TEST_F(EditSessionTest, FilesThatAreNotEdited) {
  write("a.xdd", "<?xml version=\"1.0\"?><ISO15745ProfileContainer/>");
  EXPECT_NE(open("a.xdd").problem(), "");
  write("plant.json", "{\n}\n");
  EXPECT_NE(open("plant.json").problem().find("edsc lsp"), std::string::npos);
  EXPECT_NE(open("missing.eds").problem(), "");
}

TEST_F(EditSessionTest, MalformedRequestsChangeNothing) {
  write("a.eds", small_eds);
  EditSession session = open();
  for (const char* body : {"", "[]", "{", R"({"changes":{}})", R"({"since":-1,"changes":[]})"}) {
    EXPECT_EQ(session.post("change", body).status, 400) << body;
  }
  for (const char* change : {"1", "{}", R"({"do":"pdo"})", R"({"do":"pdo","direction":"rpdo","number":513})",
                             R"({"do":"new","kind":"copy","from":"2000","to":["x"]})", R"({"do":"new","kind":"?"})",
                             R"({"do":"set","section":"2000","key":"A=B\n","value":"1"})",
                             R"({"do":"set","section":"2000","key":"Unit","value":"a\n[b]"})"}) {
    const auto answer = session.post("change", std::string{R"({"changes":[)"} + change + "]}");
    EXPECT_NE(answer.body.find("rejected"), std::string::npos) << change << answer.body;
  }
  EXPECT_EQ(session.post("other", "{}").status, 404);
  EXPECT_EQ(session.bytes(), small_eds);
}

}  // namespace
}  // namespace edsc::edit
