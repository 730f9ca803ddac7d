/// The behaviour of a simulated node without a bus: generators, rules, copies, faults and scripts.
#include "device/behaviour.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <canopen/od/dictionary.hpp>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "device/behaviour_commands.hpp"
#include "device/behaviour_script.hpp"
#include "device/entry_number.hpp"
#include "device/node_faults.hpp"
#include "load/load_device.hpp"

namespace edsc {
namespace {

constexpr std::uint64_t ms = 1'000;

/// Values without a node, and a list of what happened.
class RecordingTarget final : public BehaviourTarget {
 public:
  canopen::AbortCode set(std::uint16_t index, std::uint8_t sub_index, std::span<const std::uint8_t> bytes) override {
    values[canopen::object_key(index, sub_index)].assign(bytes.begin(), bytes.end());
    return canopen::ok;
  }
  std::optional<std::vector<std::uint8_t>> get(std::uint16_t index, std::uint8_t sub_index) override {
    const auto at = values.find(canopen::object_key(index, sub_index));
    return at != values.end() ? at->second : std::vector<std::uint8_t>(4);
  }
  void emergency(std::uint16_t code, canopen::ErrorRegister bits) override {
    events.push_back("emcy " + std::to_string(code) + " " + std::to_string(static_cast<unsigned>(bits)));
  }
  void emergency_over(canopen::ErrorRegister) override { events.emplace_back("over"); }
  void hold_error(canopen::ErrorRegister) override {}
  [[nodiscard]] canopen::NmtState nmt_state() const override { return canopen::NmtState::operational; }
  void request(canopen::NmtCommand command) override {
    events.push_back("nmt " + std::to_string(static_cast<unsigned>(command)));
  }
  void power_cycle() override { events.emplace_back("power-cycle"); }
  void set_connected(bool connected) override { events.emplace_back(connected ? "active" : "off"); }
  void start_fault(const NodeFault& fault) override { events.emplace_back(fault.row->name); }
  void clear_faults() override { events.emplace_back("clear"); }
  [[nodiscard]] std::string state_text() const override { return "recorded"; }

  std::map<std::uint32_t, std::vector<std::uint8_t>> values;
  std::vector<std::string> events;
};

class BehaviourOfDrive : public testing::Test {
 protected:
  BehaviourOfDrive() {
    Diagnostics diagnostics;
    LoadSettings settings;
    settings.path = EDSC_SOURCE_DIR "/eds/cpc-tc1.eds";
    loaded_ = load_device(settings, diagnostics);
    names_ = std::make_unique<EntryFinder>(loaded_->named());
  }

  const Entry& entry(const std::string& name) { return *names_->find_one(name).entry; }
  std::string run(const std::string& line) {
    const ParsedCommand command = parse_command(line, *names_);
    return command.problem.empty() ? command.action(behaviour_).text : command.problem;
  }
  double value(const std::string& name) {
    const Entry& one = entry(name);
    return *entry_number(one, *target_.get(one.index, one.sub_index));
  }
  /// Serves the behaviour whenever it is due, up to this time.
  void run_until(std::uint64_t end_us) {
    for (int calls = 0; calls < 100'000; ++calls) {
      const auto next = behaviour_.next_us();
      if (!next || *next > end_us) break;
      now_us_ = std::max(now_us_, *next);
      behaviour_.on_time(now_us_);
    }
    now_us_ = end_us;
    behaviour_.on_time(now_us_);
    behaviour_.on_time(now_us_);
  }
  BehaviourScript read(const std::string& json) {
    source_ = std::make_unique<SourceFile>("test.behaviour.json", json);
    BehaviourScript script = read_behaviour_script(*source_, *names_, diagnostics_);
    return script;
  }
  void add(const std::string& json) {
    behaviour_.add(read(json));
    ASSERT_EQ(diagnostics_.errors(), 0U) << diagnostics_.all().front().message;
  }
  void write(const std::string& name, double number) {
    const Entry& one = entry(name);
    const std::vector<std::uint8_t> bytes = entry_bytes(one, number);
    refused_ = behaviour_.before_write(one.index, one.sub_index, bytes);
    if (refused_ != canopen::ok) return;
    static_cast<void>(target_.set(one.index, one.sub_index, bytes));
    behaviour_.after_write(one.index, one.sub_index);
  }

  std::unique_ptr<LoadedDevice> loaded_;
  std::unique_ptr<EntryFinder> names_;
  std::unique_ptr<SourceFile> source_;
  Diagnostics diagnostics_;
  RecordingTarget target_;
  Behaviour behaviour_{target_, 1};
  std::uint64_t now_us_ = 0;
  canopen::AbortCode refused_ = canopen::ok;
};

TEST_F(BehaviourOfDrive, ARampIsLinearAndEnds) {
  behaviour_.on_power_on(0);
  EXPECT_EQ(run("ramp 6064h -100 300 200ms every 50ms"), "");
  const std::vector<double> expected = {-100, 0, 100, 200, 300};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    run_until(i * 50 * ms);
    EXPECT_EQ(value("6064h"), expected[i]);
  }
  EXPECT_EQ(run("stop 6064h"), "6064h:00 does not have a generator");
}

TEST_F(BehaviourOfDrive, ASineBeginsInTheMiddleAndReachesBothValues) {
  behaviour_.on_power_on(0);
  EXPECT_EQ(run("sine 6064h 1000 3000 400ms"), "");
  const std::vector<double> expected = {2000, 3000, 2000, 1000, 2000};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    run_until(i * 100 * ms);
    EXPECT_EQ(value("6064h"), expected[i]);
  }
}

TEST_F(BehaviourOfDrive, ACounterWrapsAndNoiseStaysBetweenItsValues) {
  behaviour_.on_power_on(0);
  EXPECT_EQ(run("count 6041h 65534 1 10ms"), "");
  EXPECT_EQ(run("noise 6064h 100 101 10ms"), "");
  for (const double expected : {65534.0, 65535.0, 0.0, 1.0}) {
    run_until(now_us_);
    EXPECT_EQ(value("6041h"), expected);
    EXPECT_GE(value("6064h"), 100);
    EXPECT_LE(value("6064h"), 101);
    now_us_ += 10 * ms;
  }
}

TEST_F(BehaviourOfDrive, ANumberOutsideTheTypeBecomesTheNearest) {
  EXPECT_EQ(entry_bytes(entry("6041h"), 70'000), (std::vector<std::uint8_t>{0xFF, 0xFF}));
  EXPECT_EQ(entry_bytes(entry("6041h"), -3), (std::vector<std::uint8_t>{0, 0}));
  EXPECT_EQ(entry_bytes(entry("6064h"), -1e12), (std::vector<std::uint8_t>{0, 0, 0, 0x80}));
  EXPECT_EQ(entry_bytes(entry("6064h"), -2.4), (std::vector<std::uint8_t>{0xFE, 0xFF, 0xFF, 0xFF}));
}

TEST_F(BehaviourOfDrive, RulesOfWritesHaveConditions) {
  add(R"({"rules": [
    {"on": {"written": "6040h", "mask": 12, "equals": 4}, "do": ["emcy 1000h 3"]},
    {"on": {"written": "6040h", "changed": true}, "times": 2, "do": ["nmt stop"]},
    {"on": {"written": "607Ah", "below": 0}, "refuse": "0609 0032h"}]})");
  behaviour_.on_power_on(0);
  write("6040h", 5);  // bits 2 and 3: 4
  run_until(1);
  EXPECT_EQ(target_.events, (std::vector<std::string>{"emcy 4096 3", "nmt 2"}));
  write("6040h", 5);
  write("6040h", 12);
  write("6040h", 13);
  run_until(2);
  EXPECT_EQ(target_.events, (std::vector<std::string>{"emcy 4096 3", "nmt 2", "emcy 4096 3", "nmt 2"}));
  write("607Ah", 0);
  EXPECT_EQ(refused_, canopen::ok);
  write("607Ah", -1);
  EXPECT_EQ(refused_, canopen::AbortCode::value_too_low);
}

TEST_F(BehaviourOfDrive, TimesOfRulesBeginAtPowerOn) {
  add(R"({"rules": [
    {"on": {"time": "20ms"}, "do": ["can off"]},
    {"on": {"every": "15ms"}, "after": "2ms", "do": ["can active"]},
    {"name": "x", "on": {"sync": 2}, "do": ["power-cycle"]},
    {"on": {"state": "stopped"}, "once": true, "do": ["fault silent for 1s", "fault clear"]}]})");
  run_until(100 * ms);
  EXPECT_TRUE(target_.events.empty());
  behaviour_.on_power_on(now_us_);
  run_until(now_us_ + 16 * ms);
  EXPECT_TRUE(target_.events.empty());
  run_until(now_us_ + 17 * ms);
  EXPECT_EQ(target_.events, (std::vector<std::string>{"active", "off", "active"}));
  target_.events.clear();
  behaviour_.on_sync();
  behaviour_.on_state(canopen::NmtState::stopped);
  behaviour_.on_sync();
  behaviour_.on_state(canopen::NmtState::stopped);
  behaviour_.on_time(now_us_);
  EXPECT_EQ(target_.events, (std::vector<std::string>{"silent", "clear", "power-cycle"}));
  EXPECT_EQ(run("fire x"), "");
  EXPECT_EQ(target_.events.back(), "power-cycle");
}

TEST_F(BehaviourOfDrive, ALimitIsPassedOnceAndACopyFollows) {
  add(R"({"generate": {"6064h": "ramp 0 100 100ms every 10ms"},
          "copy": [{"from": "6064h", "to": "606Ch", "after": "25ms"}],
          "rules": [{"on": {"changes": "6064h", "above": 45}, "do": ["emcy 4210h"]}]})");
  behaviour_.on_power_on(0);
  run_until(40 * ms);
  EXPECT_TRUE(target_.events.empty());
  EXPECT_EQ(value("606Ch"), 10);
  run_until(200 * ms);
  EXPECT_EQ(target_.events, (std::vector<std::string>{"emcy 16912 1"}));
  EXPECT_EQ(value("606Ch"), 100);
}

TEST_F(BehaviourOfDrive, ErrorsOfAScriptHaveTheirLines) {
  static_cast<void>(read("{\n\"set\": {\"nothing\": 1},\n\"copy\": [{\"from\": \"6064h\"}],\n\"rule\": []\n}"));
  ASSERT_EQ(diagnostics_.errors(), 3U);
  EXPECT_EQ(diagnostics_.all()[0].position.line, 2U);
  EXPECT_EQ(diagnostics_.all()[1].position.line, 3U);
  EXPECT_EQ(diagnostics_.all()[1].message, "a copy requires from and to");
  EXPECT_EQ(diagnostics_.all()[2].position.line, 4U);
  EXPECT_EQ(diagnostics_.all()[2].message, "unknown member rule; did you mean \"rules\"?");
}

TEST_F(BehaviourOfDrive, EachFaultAndCommandCanBeRead) {
  const std::vector<std::string> faults = {"silent",
                                           "no-boot-up",
                                           "no-heartbeat",
                                           "no-sdo",
                                           "no-sdo 1018h",
                                           "sdo-delay 5ms",
                                           "sdo-drop 1/3",
                                           "sdo-toggle",
                                           "abort 1018h:01 08000000h read",
                                           "pdo-short 1 2",
                                           "no-pdo 4",
                                           "babbling for 1s",
                                           "stuck position_actual_value",
                                           "twin",
                                           "lost-node-id"};
  for (const std::string& fault : faults) EXPECT_EQ(parse_command("fault " + fault, *names_).problem, "") << fault;
  for (const NodeFaultRow& row : node_fault_rows()) {
    const auto has = [&](const std::string& fault) { return fault.substr(0, fault.find(' ')) == row.name; };
    EXPECT_TRUE(std::any_of(faults.begin(), faults.end(), has)) << row.name;
  }
  EXPECT_EQ(parse_command("fault no-pdo 0", *names_).problem, "\"0\" is not a number from 1 to 512");
  EXPECT_EQ(parse_command("fault sdo-drop 3", *names_).problem, "\"3\" is not a fraction such as 1/3");
  EXPECT_EQ(parse_command("fault twin now", *names_).problem, "\"now\" is not expected");
  EXPECT_EQ(parse_command("ramp 6064h 0 1 1s every", *names_).problem, "TIME is missing");
  EXPECT_EQ(parse_command("can activ", *names_).problem, "\"activ\" is not off or active; did you mean \"active\"?");
}

}  // namespace
}  // namespace edsc
