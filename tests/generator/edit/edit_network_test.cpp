// A network file that is edited: the expected texts are written by hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "edit/edit_session.hpp"
#include "system/temporary_folder.hpp"

namespace edsc::edit {
namespace {

const std::string eds_folder = EDSC_SOURCE_DIR "/eds/";

const std::string plant = R"({
  "bit_rate": 125, // kbit/s
  "nodes": {
    "control": { "node_id": 127, "master": true },
    // the outputs
    "outputs": { "node_id": 1, "eds": ")" +
                          eds_folder + R"(can-2057c.eds", "heartbeat_ms": 500 },
    "inputs": { "node_id": 2, "eds": ")" +
                          eds_folder + R"(can-2053c.eds" }
  },
  "signals": [
    { "from": "inputs", "object": "6000h:01", "to": "control", "every_ms": 50 }, // at first
    { "from": "control", "object": "outputs.6200h:01", "every_ms": 50 }
  ]
}
)";

std::string plant_with(const std::string& old_text, const std::string& new_text) {
  std::string text = plant;
  const std::size_t at = text.find(old_text);
  EXPECT_NE(at, std::string::npos) << old_text;
  return at == std::string::npos ? text : text.replace(at, old_text.size(), new_text);
}

class EditNetworkTest : public ::testing::Test {
 protected:
  void write(const std::string& bytes) const { std::ofstream{path(), std::ios::binary} << bytes; }
  [[nodiscard]] std::string read() const {
    std::ostringstream text;
    text << std::ifstream{path(), std::ios::binary}.rdbuf();
    return text.str();
  }
  [[nodiscard]] std::string path() const { return folder_.path() + "/plant.json"; }
  [[nodiscard]] EditSession open() const { return EditSession{{path(), {}, folder_.path() + "/journal", {}}}; }

  static nlohmann::json post(EditSession& session, const std::string& action, const nlohmann::json& request = {}) {
    const EditAnswer answer = session.post(action, request.is_null() ? "{}" : request.dump());
    EXPECT_EQ(answer.status, 200) << answer.body;
    return nlohmann::json::parse(answer.body);
  }
  static nlohmann::json change(EditSession& session, const std::vector<nlohmann::json>& changes,
                               bool is_forced = false) {
    return post(session, "change", {{"since", session.version()}, {"changes", changes}, {"force", is_forced}});
  }
  static nlohmann::json set(const std::string& pointer, const nlohmann::json& value) {
    return {{"do", "set"}, {"pointer", pointer}, {"value", value}};
  }
  static nlohmann::json part(const EditSession& session, const std::string& name) {
    return nlohmann::json::parse(session.update(0)).at("parts").at(name);
  }
  static nlohmann::json field(const nlohmann::json& fields, const std::string& member) {
    for (const nlohmann::json& one : fields) {
      if (one["member"] == member) return one;
    }
    return nullptr;
  }
  static std::string message(const nlohmann::json& answer) {
    return answer.contains("rejected") ? answer["rejected"]["message"].get<std::string>() : "";
  }

  /// The text after changes that are made.
  [[nodiscard]] std::string text_after(const std::vector<nlohmann::json>& changes, bool is_forced = false) {
    write(plant);
    EditSession session = open();
    const auto answer = change(session, changes, is_forced);
    EXPECT_EQ(message(answer), "");
    const std::string text = session.bytes();
    post(session, "undo");
    EXPECT_EQ(session.bytes(), plant);
    return text;
  }
  /// The message of changes that are rejected.
  [[nodiscard]] std::string rejection(const std::vector<nlohmann::json>& changes) {
    write(plant);
    EditSession session = open();
    const std::string text = message(change(session, changes));
    EXPECT_EQ(session.bytes(), plant);
    return text;
  }

  TemporaryFolder folder_{"edit_network"};
};

TEST_F(EditNetworkTest, NodesOfOneEdsHaveOneListOfEntries) {
  write(plant);
  EditSession session = open();
  const nlohmann::json known = part(session, "entries");
  const nlohmann::json outputs = part(session, "network")["nodes"][1];
  const std::string eds = field(outputs["fields"], "eds")["value"];
  const auto answer =
      change(session, {{{"do", "add"}, {"pointer", "/nodes/more"}, {"members", {{"node_id", "9"}, {"eds", eds}}}}});
  ASSERT_FALSE(answer.contains("rejected")) << answer;
  EXPECT_EQ(part(session, "network")["nodes"].back()["objects"], outputs["objects"]);
  EXPECT_EQ(part(session, "entries"), known);
  EXPECT_FALSE(answer["parts"].contains("entries"));
}

TEST_F(EditNetworkTest, ShowsTheMembersOfTheFile) {
  write(plant);
  const EditSession session = open();
  ASSERT_EQ(session.problem(), "");
  EXPECT_EQ(part(session, "file")["kind"], "network");
  const auto network = part(session, "network");
  EXPECT_EQ(field(network["groups"][0]["fields"], "bit_rate"),
            nlohmann::json({{"member", "bit_rate"},
                            {"pointer", "/bit_rate"},
                            {"kind", "number"},
                            {"value", "125"},
                            {"present", true},
                            {"hint", "bit rate in kbit/s (10 to 1000)"},
                            {"offers", nullptr}}));
  EXPECT_EQ(field(network["groups"][1]["fields"], "producer")["offers"], "nodes");
  ASSERT_EQ(network["nodes"].size(), 3);
  EXPECT_EQ(network["nodes"][1]["name"], "outputs");
  EXPECT_EQ(field(network["nodes"][0]["fields"], "master")["value"], "1");
  EXPECT_EQ(field(network["nodes"][0]["fields"], "eds")["present"], false);
  EXPECT_TRUE(network["nodes"][0]["objects"].is_null());
  const auto lists = part(session, "entries")["lists"];
  const auto& objects = lists.at(network["nodes"][2]["objects"].get<std::size_t>());
  EXPECT_NE(std::ranges::find(objects, "6000h:01", [](const auto& one) { return one["text"]; }), objects.end());
  EXPECT_EQ(network["signals"][0]["title"], "inputs.6000h:01 to control");
  EXPECT_EQ(network["signals"][1]["title"], "control to outputs.6200h:01");
  EXPECT_EQ(field(network["signals"][0]["fields"], "to")["value"], nlohmann::json({"control"}));
  EXPECT_EQ(field(network["new_signal"], "to"), nlohmann::json::parse(R"({"member": "to", "kind": "list",
    "hint": "receivers: `NODE.ENTRY`, or the name of a master without a file", "offers": "receivers"})"));
  EXPECT_TRUE(field(network["new_node"], "set").is_null());
  EXPECT_NE(network["drawing"].get<std::string>().find("<svg"), std::string::npos);
  EXPECT_TRUE(network["cycle"].is_null());
  EXPECT_EQ(network["load"]["is_over"], false);
  EXPECT_EQ(network["load"]["text"].get<std::string>().find("bus load "), 0);
  bool has_sender = false;
  for (const auto& one : network["load"]["messages"])
    has_sender |= one["sender"] == "inputs" && one["can_id"] == "182h";
  EXPECT_TRUE(has_sender) << network["load"]["messages"];
}

TEST_F(EditNetworkTest, SetsMembers) {
  EXPECT_EQ(text_after({set("/nodes/outputs/node_id", "0x10")}), plant_with("\"node_id\": 1,", "\"node_id\": 16,"));
  EXPECT_EQ(text_after({set("/nodes/outputs/heartbeat_ms", "")}), plant_with(", \"heartbeat_ms\": 500", ""));
  EXPECT_EQ(text_after({set("/nodes/inputs/heartbeat_ms", "100")}),
            plant_with("can-2053c.eds\" }", "can-2053c.eds\", \"heartbeat_ms\": 100 }"));
  EXPECT_EQ(text_after({set("/disable_unused_pdos", "1")}),
            plant_with("  ]\n}", "  ],\n  \"disable_unused_pdos\": true\n}"));
  EXPECT_EQ(text_after({set("/sync/producer", "control"), set("/sync/period_us", "10000")}),
            plant_with("  ]\n}", "  ],\n  \"sync\": { \"producer\": \"control\", \"period_us\": 10000 }\n}"));
  EXPECT_EQ(text_after({set("/signals/0/to", {"control", "outputs.6200h:02"})}),
            plant_with("\"to\": \"control\"", "\"to\": [\"control\", \"outputs.6200h:02\"]"));
  EXPECT_EQ(text_after({set("/nodes/outputs/set/6206h:01", "0x0f")}),
            plant_with("500 }", "500, \"set\": { \"6206h:01\": \"0x0f\" } }"));
  EXPECT_EQ(text_after({set("/nodes/outputs/set/6206h:01", "15")}),
            plant_with("500 }", "500, \"set\": { \"6206h:01\": 15 } }"));
  EXPECT_EQ(text_after({set("/assume/sdo_ms", "5"), set("/assume/sdo_ms", ""), set("/length_m", "5")}),
            plant_with("  ]\n}", "  ],\n  \"length_m\": 5\n}"));
}

TEST_F(EditNetworkTest, AddsRemovesAndMoves) {
  EXPECT_EQ(text_after({{{"do", "add"},
                         {"pointer", "/nodes/more"},
                         {"members", {{"eds", eds_folder + "can-2053c.eds"}, {"node_id", "3"}, {"options", ""}}}}}),
            plant_with("can-2053c.eds\" }", "can-2053c.eds\" },\n    \"more\": { \"node_id\": 3, \"eds\": \"" +
                                                eds_folder + "can-2053c.eds\" }"));
  EXPECT_EQ(text_after(
                {{{"do", "add"},
                  {"pointer", "/signals/-"},
                  {"members", {{"from", "inputs"}, {"object", "6000h:02"}, {"to", {"control"}}, {"every_ms", "10"}}}}}),
            plant_with("\"every_ms\": 50 }\n",
                       "\"every_ms\": 50 },\n    { \"from\": \"inputs\", \"object\": "
                       "\"6000h:02\", \"to\": \"control\", \"every_ms\": 10 }\n"));
  const std::string first = plant.substr(plant.find("    { \"from\": \"inputs"),
                                         plant.find(", // at first") - plant.find("    { \"from\": \"inputs"));
  EXPECT_EQ(text_after({{{"do", "remove"}, {"pointer", "/signals/0"}}}), plant_with(first + ", // at first\n", ""));
  EXPECT_EQ(text_after({{{"do", "move"}, {"pointer", "/signals/0"}, {"to", 1}}}),
            plant_with(first + ", // at first\n    { \"from\": \"control\", \"object\": \"outputs.6200h:01\", "
                               "\"every_ms\": 50 }\n",
                       "    { \"from\": \"control\", \"object\": \"outputs.6200h:01\", \"every_ms\": 50 },\n" + first +
                           " // at first\n"));
}

TEST_F(EditNetworkTest, RenamesANodeWhereItIsNamed) {
  const auto rename = [](const std::string& pointer, const std::string& name) -> nlohmann::json {
    return {{"do", "rename"}, {"pointer", pointer}, {"name", name}};
  };
  std::string expected = plant_with("\"outputs\": {", "\"valves\": {");
  expected.replace(expected.find("outputs.6200h"), 7, "valves");
  EXPECT_EQ(text_after({rename("/nodes/outputs", "valves")}), expected);
  expected = plant_with("\"control\": {", "\"plc\": {");
  expected.replace(expected.find("\"control\""), 9, "\"plc\"");
  expected.replace(expected.find("\"control\""), 9, "\"plc\"");
  EXPECT_EQ(text_after({rename("/nodes/control", "plc")}), expected);
  const std::string with_sync = text_after({set("/sync/producer", "control"), rename("/nodes/control", "plc")});
  EXPECT_NE(with_sync.find("\"sync\": { \"producer\": \"plc\" }"), std::string::npos) << with_sync;
  EXPECT_EQ(rejection({rename("/nodes/outputs", "inputs")}), "\"inputs\" exists");
  EXPECT_NE(rejection({rename("/nodes/outputs", "a.b")}), "");
}

TEST_F(EditNetworkTest, RejectsWithTheAllowedValues) {
  EXPECT_EQ(rejection({set("/nodes/inputs/node_id", "128")}), "node_id: expected a number from 1 to 127, got \"128\"");
  EXPECT_EQ(rejection({set("/nodes/inputs/node_id", "-1")}), "node_id: expected a number from 1 to 127, got \"-1\"");
  EXPECT_EQ(rejection({set("/nodes/inputs/master", "yes")}), "master: expected 1 (true) or 0 (false), got \"yes\"");
  EXPECT_EQ(rejection({set("/nodes/inputs/eds", nlohmann::json::array())}), "eds: expected a text");
  EXPECT_EQ(rejection({set("/nodes/inputs/color", "red")}), "node inputs does not have a member \"color\"");
  EXPECT_EQ(rejection({set("/nodes/other/node_id", "1")}), "node other does not exist");
  EXPECT_EQ(rejection({{{"do", "add"}, {"pointer", "/nodes/inputs"}, {"members", nlohmann::json::object()}}}),
            "a node \"inputs\" exists");
}

TEST_F(EditNetworkTest, RejectsWhatAddsAnError) {
  write(plant);
  EditSession session = open();
  const std::vector<nlohmann::json> changes{set("/length_m", "10"), {{"do", "remove"}, {"pointer", "/nodes/inputs"}}};
  const auto answer = change(session, changes);
  ASSERT_TRUE(answer.contains("rejected")) << answer;
  EXPECT_EQ(answer["rejected"]["index"], 1);
  EXPECT_EQ(answer["rejected"]["can_force"], true);
  EXPECT_EQ(answer["rejected"]["findings"][0]["section"], "/signals/0/from");
  EXPECT_EQ(session.bytes(), plant);
  EXPECT_EQ(message(change(session, changes, true)), "");
  EXPECT_EQ(part(session, "findings")["errors"], 1);
  EXPECT_EQ(part(session, "findings")["list"][0]["section"], "/signals/0/from");
  const auto review = post(session, "review");
  EXPECT_EQ(review["new"].size(), 1);
  EXPECT_TRUE(review["broken"].empty());
}

TEST_F(EditNetworkTest, ATextThatIsNotJsonIsShownOnly) {
  const std::string broken = plant_with("\"signals\": [", "\"signals\": ");
  write(broken);
  EditSession session = open();
  ASSERT_EQ(session.problem(), "");
  EXPECT_TRUE(part(session, "network").is_null());
  EXPECT_EQ(part(session, "findings")["list"][0]["rule"], "network-syntax");
  EXPECT_NE(message(change(session, {set("/bit_rate", "250")})), "");
  EXPECT_EQ(session.bytes(), broken);
  const auto text = nlohmann::json::parse(session.section("").body);
  EXPECT_EQ(text["line"], 1);
  EXPECT_EQ(text["lines"].size(), std::ranges::count(broken, '\n'));
  EXPECT_EQ(session.section("/nodes").status, 404);
  write(plant);
  EXPECT_TRUE(session.look_at_disk());
  EXPECT_FALSE(part(session, "network").is_null());
}

TEST_F(EditNetworkTest, SavesAndMergesAsAnEds) {
  write(plant);
  EditSession session = open();
  change(session, {set("/bit_rate", "250")});
  const std::string theirs = plant_with("\"node_id\": 2", "\"node_id\": 7");
  write(theirs);
  EXPECT_TRUE(session.look_at_disk());
  post(session, "save");
  std::string expected = theirs;
  EXPECT_EQ(read(), expected.replace(expected.find("125"), 3, "250"));
}

TEST_F(EditNetworkTest, SeesChangesOfTheFilesThatItNames) {
  const std::string name = eds_folder + "can-2053c.eds";
  write(plant_with(name, "new.eds"));
  EditSession session = open();
  EXPECT_EQ(part(session, "findings")["errors"], 1);
  EXPECT_FALSE(session.look_at_disk());
  const std::string path = folder_.path() + "/new.eds";
  std::filesystem::copy_file(name, path);
  EXPECT_TRUE(session.look_at_disk());
  EXPECT_EQ(part(session, "findings")["errors"], 0);
  EXPECT_FALSE(session.look_at_disk());
  std::ofstream{path} << "[FileInfo]\n";
  EXPECT_TRUE(session.look_at_disk());
  EXPECT_GT(part(session, "findings")["errors"], 0);
  EXPECT_FALSE(session.has_unsaved_edits());
}

TEST_F(EditNetworkTest, NamesItsSteps) {
  write(plant);
  EditSession session = open();
  const auto name_of = [&](const nlohmann::json& request) {
    EXPECT_EQ(message(change(session, {request}, true)), "");
    return part(session, "status")["undo"].get<std::string>();
  };
  const auto request = [](const char* kind, const char* pointer) -> nlohmann::json {
    return {{"do", kind}, {"pointer", pointer}, {"name", "doors"}, {"to", 0}, {"members", {{"node_id", "9"}}}};
  };
  EXPECT_EQ(name_of(set("/bit_rate", "250")), "set bit_rate of the network to 250");
  EXPECT_EQ(name_of(set("/sync/producer", "control")), "set producer of SYNC to control");
  EXPECT_EQ(name_of(set("/nodes/inputs/set/1017h", "5")), "set 1017h of node inputs to 5");
  EXPECT_EQ(name_of(request("remove", "/nodes/inputs/set/1017h")), "remove 1017h of node inputs");
  EXPECT_EQ(name_of(set("/signals/0/to", {"a", "b"})), "set to of signal 1 to a, b");
  EXPECT_EQ(name_of(set("/signals/0/every_ms", "")), "remove every_ms of signal 1");
  EXPECT_EQ(name_of(request("rename", "/nodes/inputs")), "rename node inputs to doors");
  EXPECT_EQ(name_of(request("move", "/signals/1")), "move signal 2 to place 1");
  EXPECT_EQ(name_of(request("add", "/nodes/more")), "add node more");
  EXPECT_EQ(name_of(request("remove", "/nodes/more")), "remove node more");
}

TEST_F(EditNetworkTest, KeepsTheEncoding) {
  const std::string with_mark = "\xEF\xBB\xBF" + plant;
  write(with_mark);
  EditSession session = open();
  change(session, {set("/bit_rate", "250")});
  std::string expected = with_mark;
  EXPECT_EQ(session.bytes(), expected.replace(expected.find("125"), 3, "250"));
}

TEST_F(EditNetworkTest, ShowsTheLinesOfAValue) {
  write(plant);
  const EditSession session = open();
  const EditAnswer answer = session.section("/nodes/inputs");
  const auto section = nlohmann::json::parse(answer.body);
  EXPECT_EQ(section["line"], 7);
  EXPECT_EQ(section["lines"].size(), 1);
  EXPECT_EQ(session.section("/nodes/other").status, 404);
  EXPECT_EQ(session.section("nodes").status, 404);
}

TEST_F(EditNetworkTest, ShowsADeepValueAsItsText) {
  constexpr std::size_t depth = 20'000;
  const std::string deep = std::string(depth, '[') + std::string(depth, ']');
  write(R"({"bit_rate": )" + deep + R"(, "nodes": {"a": {"set": {"1": )" + deep + R"(}}}, "signals": [{"to": [)" +
        deep + "]}]}");
  EditSession session = open();
  ASSERT_EQ(session.problem(), "");
  EXPECT_EQ(field(part(session, "network")["groups"][0]["fields"], "bit_rate")["value"], deep);
  change(session, {set("/bit_rate", "125"), set("/signals/0/to", {"a", "b"}), set("/nodes/a/set/1", "5")}, true);
  EXPECT_EQ(session.bytes(),
            R"({"bit_rate": 125, "nodes": {"a": {"set": {"1": 5}}}, "signals": [{"to": ["a", "b"]}]})");
}

TEST_F(EditNetworkTest, HostileRequestsChangeNothing) {
  write(plant);
  EditSession session = open();
  for (const char* request : {"1",
                              "[]",
                              "{}",
                              R"({"do":"set"})",
                              R"({"do":"set","pointer":"x","value":"1"})",
                              R"({"do":"set","pointer":"","value":"1"})",
                              R"({"do":"set","pointer":"/bit_rate","value":1})",
                              R"({"do":"set","pointer":"/bit_rate/x","value":"1"})",
                              R"({"do":"set","pointer":"/nodes","value":"1"})",
                              R"({"do":"set","pointer":"/nodes/inputs/set","value":"1"})",
                              R"({"do":"remove","pointer":""})",
                              R"({"do":"remove","pointer":"/signals/2"})",
                              R"({"do":"remove","pointer":"/signals/-"})",
                              R"({"do":"move","pointer":"/signals/0","to":2})",
                              R"({"do":"move","pointer":"/signals/0","to":-1})",
                              R"({"do":"rename","pointer":"/signals/0","name":"x"})",
                              R"({"do":"rename","pointer":"/nodes/inputs","name":""})",
                              R"({"do":"add","pointer":"/signals/0","members":{}})",
                              R"({"do":"add","pointer":"/nodes/","members":{}})",
                              R"({"do":"add","pointer":"/nodes/x","members":{"color":"red"}})",
                              R"({"do":"?","pointer":"/bit_rate"})"}) {
    const EditAnswer answer = session.post("change", std::string{R"({"changes":[)"} + request + "]}");
    EXPECT_NE(answer.body.find("rejected"), std::string::npos) << request << answer.body;
  }
  EXPECT_EQ(session.bytes(), plant);
}

}  // namespace
}  // namespace edsc::edit
