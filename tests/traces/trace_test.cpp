/// The language of the traces.
#include "trace.hpp"

#include <gtest/gtest.h>

#include <canopen/lss/lss_protocol.hpp>
#include <sstream>
#include <stdexcept>
#include <string>

namespace {

trace::Trace read(const std::string& text) {
  std::istringstream stream{text};
  return trace::read(stream, "example.trace");
}

/// The error message of the reader for a text; empty if it accepts the text.
std::string refusal(const std::string& text) {
  try {
    static_cast<void>(read(text));
    return "";
  } catch (const std::runtime_error& problem) {
    return problem.what();
  }
}

const std::string one_node = "device cpd\nnode 1\n";
const std::string two_nodes = "device can-2057c\nnode 1\ndevice can-2053c\nnode 2\n";

TEST(TraceReader, ReadsADataFrame) {
  const trace::Trace trace = read(one_node + "> 601  2B 01 18 03 F0 20 -- 0a   # a comment\n");
  ASSERT_EQ(trace.lines.size(), 1u);
  const trace::Line& line = trace.lines[0];
  EXPECT_EQ(line.number, 3u);
  EXPECT_EQ(line.step, trace::Step::send);
  EXPECT_EQ(trace::to_text(line.pattern), "601  2B 01 18 03 F0 20 -- 0A");
  EXPECT_EQ(line.pattern.any, 0x40);
}

TEST(TraceReader, ReadsAFrameWithoutData) {
  const trace::Trace trace = read(one_node + "> 080\n");
  EXPECT_EQ(trace.lines.at(0).pattern.frame.id, 0x80u);
  EXPECT_EQ(trace.lines[0].pattern.frame.size, 0);
  EXPECT_FALSE(trace.lines[0].pattern.frame.remote);
}

TEST(TraceReader, ReadsARemoteFrameWithAndWithoutALength) {
  const trace::Trace trace = read(one_node + "> 284 R\n> 284 R 8\n");
  ASSERT_EQ(trace.lines.size(), 2u);
  EXPECT_TRUE(trace.lines[0].pattern.frame.remote);
  EXPECT_EQ(trace.lines[0].pattern.frame.size, 0);
  EXPECT_TRUE(trace.lines[1].pattern.frame.remote);
  EXPECT_EQ(trace.lines[1].pattern.frame.size, 8);
}

TEST(TraceReader, ReadsAnExtendedIdOfEightDigits) {
  const trace::Trace trace = read(one_node + "< 00000601  01\n");
  EXPECT_TRUE(trace.lines.at(0).pattern.frame.extended);
  EXPECT_EQ(trace.lines[0].pattern.frame.id, 0x601u);
}

TEST(TraceReader, TakesObjectsToBeThoseOfTheOnlyNode) {
  const trace::Trace trace = read(one_node + "= 6064h:00 -2\nread 1008h:00 \"a # b\"\n");
  ASSERT_EQ(trace.nodes.size(), 1u);
  EXPECT_EQ(trace.nodes[0].device, "cpd");
  EXPECT_EQ(trace.nodes[0].node_id.value(), 1);
  ASSERT_EQ(trace.lines.size(), 2u);
  EXPECT_EQ(trace.lines[0].node, 0u);
  EXPECT_EQ(trace.lines[0].index, 0x6064);
  EXPECT_EQ(trace.lines[0].value.bytes(4), (std::vector<std::uint8_t>{0xFE, 0xFF, 0xFF, 0xFF}));
  EXPECT_EQ(trace.lines[1].value.text, "a # b");
}

TEST(TraceReader, TakesTheNodeOfAnObjectFromTheLineWhereThereAreSeveral) {
  const trace::Trace trace = read(two_nodes + "= node 2 6000h:01 0x34\nread node 1 6200h:02 0x12\n");
  ASSERT_EQ(trace.nodes.size(), 2u);
  EXPECT_EQ(trace.nodes[1].device, "can-2053c");
  ASSERT_EQ(trace.lines.size(), 2u);
  EXPECT_EQ(trace.lines[0].node, 1u);
  EXPECT_EQ(trace.lines[0].sub_index, 1);
  EXPECT_EQ(trace.lines[0].value.number, 0x34u);
  EXPECT_EQ(trace.lines[1].node, 0u);
}

TEST(TraceReader, ReadsLinesOfInputOfAnApplication) {
  const std::string head = "application cpd\nnode 1\n";
  const trace::Trace trace = read(head + "! limit negative  on  # a switch\n~ 481\n");
  ASSERT_EQ(trace.nodes.size(), 1u);
  EXPECT_TRUE(trace.nodes[0].has_application);
  ASSERT_EQ(trace.lines.size(), 2u);
  EXPECT_EQ(trace.lines[0].step, trace::Step::input);
  EXPECT_EQ(trace.lines[0].input, "limit negative on");
  EXPECT_EQ(trace.lines[1].step, trace::Step::disregard);
  EXPECT_EQ(trace.lines[1].pattern.frame.id, 0x481u);
  EXPECT_THROW(read(one_node + "! limit negative on\n"), std::runtime_error);
}

TEST(TraceReader, ReadsTimes) {
  const trace::Trace trace = read(one_node + "+ 999 ms\n+ 1 s\n+ 5 us\n");
  ASSERT_EQ(trace.lines.size(), 3u);
  EXPECT_EQ(trace.lines[0].span.count(), 999'000);
  EXPECT_EQ(trace.lines[1].span.count(), 1'000'000);
  EXPECT_EQ(trace.lines[2].span.count(), 5);
}

TEST(TraceReader, ReadsAnErrorOfTheApplication) {
  const trace::Trace trace = read(two_nodes + "emergency node 2 0x8611 0x20 09 0a\nemergency node 1 over 0x81\n");
  ASSERT_EQ(trace.lines.size(), 2u);
  EXPECT_EQ(trace.lines[0].step, trace::Step::emergency);
  EXPECT_EQ(trace.lines[0].node, 1u);
  EXPECT_EQ(trace.lines[0].emergency.code, 0x8611);
  EXPECT_EQ(trace.lines[0].emergency.bits, canopen::ErrorRegister::device_profile);
  EXPECT_EQ(trace.lines[0].emergency.info, (canopen::EmergencyInfo{0x09, 0x0A, 0, 0, 0}));
  EXPECT_EQ(trace.lines[1].step, trace::Step::emergency_over);
  EXPECT_EQ(trace.lines[1].node, 0u);
  EXPECT_EQ(trace.lines[1].emergency.bits, canopen::ErrorRegister::generic | canopen::ErrorRegister::manufacturer);
}

TEST(TraceReader, ReadsWherePowerGoes) {
  const trace::Trace trace = read(one_node + "power on\n< 701 00\npower off\n+ 1 s\npower on\n< 701 00\n");
  EXPECT_TRUE(trace.power_on);
  ASSERT_EQ(trace.lines.size(), 5u);
  EXPECT_EQ(trace.lines[1].step, trace::Step::power_off);
  EXPECT_EQ(trace.lines[3].step, trace::Step::power_on);
  EXPECT_FALSE(read(one_node + "> 080\npower off\npower on\n").power_on);
}

TEST(TraceReader, Takes255ForADeviceWithoutNodeId) {
  EXPECT_EQ(read("device rk5c\nnode 255\n").nodes.at(0).node_id, canopen::unconfigured_node_id);
}

TEST(TraceReader, NamesFileAndLineOfWhatItDoesNotUnderstand) {
  struct Row {
    std::string text;
    std::string refusal;
  };
  const Row rows[] = {
      {one_node + "? 601\n", "example.trace:3: \"?\" begins no line of a trace"},
      {one_node + "> 801\n", "example.trace:3: \"801\" is too high"},
      {one_node + "> 601 00 01 02 03 04 05 06 07 08\n", "example.trace:3: a frame has eight bytes at most"},
      {one_node + "> 601 100\n", "example.trace:3: \"100\" is too high"},
      {one_node + "> 284 R 9\n", "example.trace:3: \"9\" is too high"},
      {one_node + "+ 5 min\n", "example.trace:3: a time is a number and us, ms or s"},
      {one_node + "= 6041:00 1\n", "example.trace:3: an object is written 1801h:03"},
      {one_node + "= node 3 6000h:01 1\n", "example.trace:3: no such node on the bus"},
      {two_nodes + "= 6000h:01 1\n", "example.trace:5: which node? It is written before the rest: node 2"},
      {"device cpd\nnode 0\n", "example.trace:2: a node-ID is 1 to 127, or 255"},
      {"device cpd\nnode 128\n", "example.trace:2: a node-ID is 1 to 127, or 255"},
      {"device cpd\nnode 256\n", "example.trace:2: \"256\" is too high"},
      {"node 1\n", "example.trace:1: a node-ID stands below its device"},
      {"device cpd\nnode 1\nnode 2\n", "example.trace:3: a node-ID stands below its device"},
      {"device cpd\ndevice rk5c\n", "example.trace:2: the device above has no node-ID"},
      {"device cpd\nnode 1\ndevice rk5c\nnode 1\n", "example.trace:4: two nodes have this node-ID"},
      {one_node + "emergency 0x10000 0x01\n", "example.trace:3: \"0x10000\" is too high"},
      {one_node + "emergency 0x1000 0x01 0 0 0 0 0 0\n",
       "example.trace:3: an error has five bytes of the manufacturer, and one that is over has none"},
      {one_node + "emergency over 0x01 00\n",
       "example.trace:3: an error has five bytes of the manufacturer, and one that is over has none"},
      {two_nodes + "emergency 0x1000 0x01\n", "example.trace:5: which node? It is written before the rest: node 2"},
      {one_node + "power on\npower on\n", "example.trace:4: power goes on where it is off, and off where it is on"},
      {one_node + "power off\npower off\n", "example.trace:4: power goes on where it is off, and off where it is on"},
      {one_node + "power off\n> 080\n", "example.trace:4: the power is off"},
      {"device cpd\n", "example.trace: no device or no node-ID"},
      {"", "example.trace: no device or no node-ID"},
  };
  for (const Row& row : rows) EXPECT_EQ(refusal(row.text), row.refusal) << row.text;
}

}  // namespace
