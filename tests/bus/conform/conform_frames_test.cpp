/// The frames that a failure names: SDO transfers among the frames of a case, and the part of them that reports show.
#include <gtest/gtest.h>

#include <algorithm>
#include <canopen/base/abort_code.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "conform/dut/sdo_transfers.hpp"
#include "conform/named_entries.hpp"
#include "conform/report/decoded_frames.hpp"
#include "conform/report/html_report.hpp"
#include "conform/report/json_report.hpp"
#include "conform/report/junit_report.hpp"
#include "conform/report/report_facts.hpp"
#include "conform/report/text_report.hpp"
#include "report_runs.hpp"

namespace edsc::conform {
namespace {

using Positions = std::vector<std::size_t>;
using Frames = std::vector<SeenFrame>;

constexpr canopen::NodeId node{5};

SeenFrame request(std::vector<std::uint8_t> data) {
  data.resize(8);
  return seen(1000, true, 0x605, std::move(data));
}
SeenFrame response(std::vector<std::uint8_t> data) {
  data.resize(8);
  return seen(2000, false, 0x585, std::move(data));
}

// CiA 301, 7.2.4.3: command specifiers of the frames below. 0601 0002h is sent low byte first.
const SeenFrame read_1015 = request({0x40, 0x15, 0x10, 0}), value_of_1015 = response({0x4B, 0x15, 0x10, 0, 1});
const SeenFrame write_1015 = request({0x2B, 0x15, 0x10, 0, 2}),
                refusal_of_1015 = response({0x80, 0x15, 0x10, 0, 0x02, 0x00, 0x01, 0x06});
const SeenFrame write_1017 = request({0x2B, 0x17, 0x10, 0, 2}), confirmation_of_1017 = response({0x60, 0x17, 0x10, 0});
const SeenFrame heartbeat = seen(3000, false, 0x705, {0x7F});

Positions positions_of(const Frames& frames, std::uint16_t index, std::uint8_t sub_index = 0) {
  return last_transfer(frames, node, index, sub_index);
}

TEST(SdoTransfers, AreFoundByTheirEntry) {
  const Frames frames = {read_1015,       value_of_1015, heartbeat, write_1015,          heartbeat,
                         refusal_of_1015, write_1017,    heartbeat, confirmation_of_1017};
  EXPECT_EQ(positions_of(frames, 0x1015), (Positions{3, 5})) << "the last one, without other frames";
  EXPECT_EQ(positions_of(frames, 0x1017), (Positions{6, 8}));
  EXPECT_EQ(positions_of(frames, 0x1015, 1), Positions{});
  EXPECT_EQ(positions_of(frames, 0x1018), Positions{});
  EXPECT_EQ(positions_of({}, 0x1015), Positions{});
}

TEST(SdoTransfers, WithoutResponseAreTheRequest) {
  EXPECT_EQ(positions_of({read_1015, heartbeat}, 0x1015), Positions{0});
}

TEST(SdoTransfers, AreThoseOfTheNode) {
  SeenFrame of_other = read_1015;
  of_other.frame.id = 0x606;
  SeenFrame received = read_1015;
  received.sent = false;
  EXPECT_EQ(positions_of({of_other, received}, 0x1015), Positions{});
}

/// A segmented upload: initiate, then a request and a response for each segment.
TEST(SdoTransfers, ThatAreLongHaveTheirBeginningAndEnd) {
  Frames frames = {request({0x40, 0x08, 0x10, 0}), response({0x41, 0x08, 0x10, 0, 20})};
  for (int i = 0; i < 3; ++i) {
    frames.push_back(request({0x60}));
    frames.push_back(response({0x00, 'a'}));
  }
  EXPECT_EQ(positions_of(frames, 0x1008), (Positions{0, 1, 6, 7}));
}

TEST(SdoTransfers, AreRefusedWritesIfEachIsRefused) {
  const Frames frames = {write_1015, refusal_of_1015, write_1017, confirmation_of_1017, read_1015, value_of_1015};
  const auto writes = [&](const Positions& positions) { return refused_writes(frames, node, positions); };
  const std::vector<RefusedWrite> refused = {{0x1015, 0, canopen::AbortCode::read_only}};
  EXPECT_EQ(writes({0, 1}), refused);
  EXPECT_TRUE(writes({0, 1, 2, 3}).empty()) << "one is confirmed";
  EXPECT_TRUE(writes({0, 1, 4, 5}).empty()) << "one is a read";
  EXPECT_TRUE(writes({0}).empty()) << "no response";
  EXPECT_TRUE(writes({}).empty());
}

TEST(NamedEntries, AreThoseOfTheText) {
  const std::vector<EntryAddress> expected = {{0x1A00, std::uint8_t{1}}, {0x6041, std::uint8_t{0}}};
  EXPECT_EQ(entries_in("1A00h:01 with 16 bits of 6041h:00, not 2h:00, CAN-ID 181h, 16041h:00 or 6041h"), expected);
}

// ---- which frames a report shows ----

TEST(ShownFrames, AreTheLastOnesWithoutNamedFrames) {
  EXPECT_EQ(shown_frames(5, {}, 3), (Positions{2, 3, 4}));
  EXPECT_EQ(shown_frames(2, {}, 3), (Positions{0, 1}));
  EXPECT_EQ(shown_frames(0, {}, 3), Positions{});
}

TEST(ShownFrames, AreThoseThatAreNamedAndTheOnesAround) {
  EXPECT_EQ(shown_frames(100, Positions{10, 11}, 6), (Positions{8, 9, 10, 11, 12, 13}));
  EXPECT_EQ(shown_frames(100, Positions{0}, 3), (Positions{0, 1, 2}));
  EXPECT_EQ(shown_frames(100, Positions{99}, 3), (Positions{97, 98, 99}));
  EXPECT_EQ(shown_frames(100, Positions{10, 50}, 6), (Positions{9, 10, 11, 49, 50, 51}));
  EXPECT_EQ(shown_frames(100, Positions{10, 20, 30, 40}, 3), (Positions{10, 20, 30}));
}

/// A failure with many reads after the frames that it is about.
RunReport failure_with_later_reads() {
  RunReport run = every_verdict();
  CaseResult& failed = run.cases[1];
  failed.frames.assign(100, seen(5'000'000, false, 0x705, {0x05}));
  failed.frames[40] = seen(5'000'000, true, 0x605, {0x40, 0x04, 0x10, 0, 0, 0, 0, 0});
  failed.frames[41] = seen(5'000'000, false, 0x585, {0x80, 0x04, 0x10, 0, 0x11, 0, 0x09, 0x06});
  failed.failed_frames = {40, 41};
  return run;
}

TEST(ShownFrames, AreMarkedInEachReport) {
  const RunReport run = failure_with_later_reads();
  const std::string text = TextReport{run, sheet().device, false}.of(run.cases[1]);
  EXPECT_NE(text.find("frames        31 earlier frames not shown; --log writes all frames\n"), std::string::npos)
      << text;
  EXPECT_NE(text.find("\n                     > 5.000000 TX 605 40 04 10 00"), std::string::npos) << text;
  EXPECT_NE(text.find("\n                     > 5.000000 RX 585 80 04 10 00"), std::string::npos) << text;
  EXPECT_NE(text.find("\n                       5.000000 RX 705 05"), std::string::npos) << text;
  EXPECT_NE(text.find("\n                     49 later frames not shown\n"), std::string::npos) << text;

  const auto json = nlohmann::json::parse(json_report(run, sheet().device))["cases"][1];
  ASSERT_EQ(json["failed_frames"], nlohmann::json::array({40, 41}));
  EXPECT_EQ(json["frames"][40]["data"], "4004100000000000");
  EXPECT_NE(junit_report(run, sheet().device).find("\n&gt; 5.000000 TX 605"), std::string::npos);
  const std::string html = html_report(run, sheet().device);
  EXPECT_NE(html.find("marked: the frames that the failed check names"), std::string::npos);
  const std::size_t first = html.find(" named\"><td>5.000000</td><td>TX</td><td>605</td>");
  EXPECT_NE(first, std::string::npos);
  EXPECT_NE(html.find(" named\"><td>5.000000</td><td>RX</td><td>585</td>", first), std::string::npos);
}

TEST(ShownFrames, HaveTheNumberOfThoseBetween) {
  RunReport run = failure_with_later_reads();
  run.cases[1].failed_frames = {10, 90};
  const std::vector<std::string> lines =
      frame_lines(run.cases[1].frames, 5, sheet().device, 6, run.cases[1].failed_frames);
  ASSERT_EQ(lines.size(), 9U);
  EXPECT_EQ(lines[0], "9 earlier frames not shown; --log writes all frames");
  EXPECT_EQ(lines[4], "77 frames not shown");
  EXPECT_EQ(lines[8], "8 later frames not shown");
}

// ---- failures with one cause ----

TEST(ConformRun, GroupsFailuresByTheRefusedWrite) {
  const RefusedWrite of_1015{0x1015, 0, canopen::AbortCode::read_only};
  const RefusedWrite of_1017{0x1017, 0, canopen::AbortCode::read_only};
  RunReport run;
  run.cases = {failure(read_row, "accepts", "1015h:00: refused; 1017h:00: refused"), failure(save_row, "accepts", "x"),
               failure(sync_row, "1015h:00 written", "0601 0002h"), failure(outputs_row, "an EMCY", "none")};
  run.cases[0].refused_writes = {of_1015, of_1017};
  run.cases[1].refused_writes = {of_1017};
  run.cases[2].refused_writes = {of_1015};
  const std::vector<Cause> causes = run.causes();
  ASSERT_EQ(causes.size(), 2U);
  EXPECT_EQ(case_ids(causes[0].cases), "2.6, 8.4, 3.7");
  EXPECT_EQ(causes[0].text,
            "the device refuses to write 1015h:00: 0601 0002h, write of a read-only object; "
            "1017h:00: 0601 0002h, write of a read-only object");
  EXPECT_EQ(causes_sentence(run), "4 failed cases, 2 causes");
}

TEST(ConformRun, HasTwoCausesIfTheCodeOrTheEntryDiffers) {
  RunReport run;
  run.cases = {failure(read_row, "accepts", "x"), failure(sync_row, "accepts", "y"), failure(save_row, "accepts", "z")};
  run.cases[0].refused_writes = {{0x1015, 0, canopen::AbortCode::read_only}};
  run.cases[1].refused_writes = {{0x1015, 0, canopen::AbortCode::general}};
  run.cases[2].refused_writes = {{0x1015, 1, canopen::AbortCode::read_only}};
  ASSERT_EQ(run.causes().size(), 3U);
  EXPECT_EQ(run.causes()[0].text, "2.6 A missing object is refused: x") << "the cause of one case is its failure";
}

}  // namespace
}  // namespace edsc::conform
