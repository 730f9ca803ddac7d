/// The SDO client with block transfer: uploads and downloads.
#include <gtest/gtest.h>
#include <canopen/sdo/sdo_client.hpp>

#include <string>

#include "counting.hpp"
#include "sdo_client_bench.hpp"
#include "support/bench.hpp"

namespace {

using bench::counting;
using canopen::AbortCode;
using client_bench::bytes_of;
using client_bench::Client;
using namespace std::chrono_literals;

// Upload

TEST(SdoBlockClientUpload, TakesAValueWithItsCrc) {
  Client client;
  EXPECT_EQ(client.upload(), "A4 12 20 00 7F 04 00 00");
  EXPECT_EQ(client.answer("C6 12 20 00 0D 00 00 00"), "A3 00 00 00 00 00 00 00");
  EXPECT_EQ(client.answer("01 53 61 6D 70 6C 65 20"), "");
  EXPECT_EQ(client.answer("82 64 65 76 69 63 65 00"), "A2 02 7F 00 00 00 00 00");
  EXPECT_TRUE(client.client.busy());
  EXPECT_EQ(client.answer("C5 61 AE 00 00 00 00 00"), "A1 00 00 00 00 00 00 00");
  EXPECT_FALSE(client.client.busy());
  EXPECT_EQ(client.client.result(), canopen::ok);
  const auto data = client.client.data();
  EXPECT_EQ(std::string(data.begin(), data.end()), "Sample device");
}

TEST(SdoBlockClientUpload, ConfirmsEachSubBlockOfTheSizeThatItHasAskedFor) {
  Client client{{.block_transfer = true, .block_threshold = 4, .block_size = 2}};
  EXPECT_EQ(client.upload(), "A4 12 20 00 02 04 00 00");
  client.answer("C2 12 20 00 15 00 00 00");
  EXPECT_EQ(client.answer("01 01 02 03 04 05 06 07"), "");
  EXPECT_EQ(client.answer("02 08 09 0A 0B 0C 0D 0E"), "A2 02 02 00 00 00 00 00");
  EXPECT_EQ(client.answer("81 0F 10 11 12 13 14 15"), "A2 01 02 00 00 00 00 00");
  EXPECT_EQ(client.answer("C1 00 00 00 00 00 00 00"), "A1 00 00 00 00 00 00 00");
  EXPECT_EQ(client.client.data().size(), 21u);
}

TEST(SdoBlockClientUpload, ConfirmsTheLastSegmentBeforeALostOne) {
  Client client{{.block_transfer = true, .block_threshold = 4, .block_size = 3}};
  client.upload();
  client.answer("C6 12 20 00 15 00 00 00");
  client.answer("01 01 02 03 04 05 06 07");
  EXPECT_EQ(client.answer("83 0F 10 11 12 13 14 15"), "A2 01 03 00 00 00 00 00");
  EXPECT_EQ(client.answer("01 08 09 0A 0B 0C 0D 0E"), "");
  EXPECT_EQ(client.answer("01 08 09 0A 0B 0C 0D 0E"), "");  // twice
  EXPECT_EQ(client.answer("82 0F 10 11 12 13 14 15"), "A2 02 03 00 00 00 00 00");
  client.answer("C1 1F AA 00 00 00 00 00");
  EXPECT_EQ(client.client.result(), AbortCode::crc);
}

TEST(SdoBlockClientUpload, ConfirmsWhatHasComeOfASubBlockWhoseEndIsOverdue) {
  Client client;
  client.upload();
  client.answer("C2 12 20 00 0E 00 00 00");
  client.answer("01 01 02 03 04 05 06 07");
  EXPECT_EQ(client.pass(99ms), "");
  EXPECT_EQ(client.pass(1ms), "A2 01 7F 00 00 00 00 00");
  EXPECT_EQ(client.answer("81 08 09 0A 0B 0C 0D 0E"), "A2 01 7F 00 00 00 00 00");
  client.answer("C1 00 00 00 00 00 00 00");
  EXPECT_EQ(client.client.result(), canopen::ok);
}

TEST(SdoBlockClientUpload, GivesUpWhenNothingComesOfASubBlock) {
  Client client;
  client.upload();
  client.answer("C2 12 20 00 0E 00 00 00");
  EXPECT_EQ(client.pass(100ms), "80 12 20 00 00 00 04 05");
  EXPECT_EQ(client.client.result(), AbortCode::timeout);
}

TEST(SdoBlockClientUpload, GivesUpWhenNothingComesThroughAgainAndAgain) {
  Client client{{.block_transfer = true, .block_threshold = 4, .block_size = 2, .block_retries = 2}};
  client.upload();
  client.answer("C2 12 20 00 0E 00 00 00");
  EXPECT_EQ(client.answer("82 08 09 0A 0B 0C 0D 0E"), "A2 00 02 00 00 00 00 00");
  EXPECT_EQ(client.answer("82 08 09 0A 0B 0C 0D 0E"), "A2 00 02 00 00 00 00 00");
  EXPECT_EQ(client.answer("82 08 09 0A 0B 0C 0D 0E"), "80 12 20 00 03 00 04 05");
  EXPECT_EQ(client.client.result(), AbortCode::sequence_number);
}

TEST(SdoBlockClientUpload, LooksAtTheCrcOnlyWhereTheServerHasOne) {
  Client client;
  client.upload();
  client.answer("C0 12 20 00 00 00 00 00");
  client.answer("81 41 00 00 00 00 00 00");
  client.answer("D9 FF FF 00 00 00 00 00");
  EXPECT_EQ(client.client.result(), canopen::ok);
  EXPECT_EQ(client.client.data().size(), 1u);
}

TEST(SdoBlockClientUpload, TakesAShortValueBySegmentsOrExpedited) {
  Client client;
  client.upload();
  EXPECT_EQ(client.answer("41 12 20 00 05 00 00 00"), "60 00 00 00 00 00 00 00");
  EXPECT_EQ(client.answer("05 01 02 03 04 05 00 00"), "");
  EXPECT_EQ(client.client.data().size(), 5u);
  client.upload();
  EXPECT_EQ(client.answer("4B 12 20 00 01 02 00 00"), "");
  EXPECT_EQ(client.client.data().size(), 2u);
}

TEST(SdoBlockClientUpload, FallsBackToSegmentsAndRemembersIt) {
  Client client;
  client.upload();
  EXPECT_EQ(client.answer("80 12 20 00 01 00 04 05"), "40 12 20 00 00 00 00 00");
  EXPECT_EQ(client.answer("41 12 20 00 05 00 00 00"), "60 00 00 00 00 00 00 00");
  EXPECT_EQ(client.answer("05 01 02 03 04 05 00 00"), "");
  EXPECT_EQ(client.client.result(), canopen::ok);
  EXPECT_EQ(client.upload(), "40 12 20 00 00 00 00 00");
}

TEST(SdoBlockClientUpload, HandsOtherAbortCodesOn) {
  Client client;
  client.upload();
  EXPECT_EQ(client.answer("80 12 20 00 24 00 00 08"), "");
  EXPECT_EQ(client.client.result(), AbortCode::no_data);
}

TEST(SdoBlockClientUpload, EndsWithAnAbortOfTheServerAmongTheSegments) {
  Client client;
  client.upload();
  client.answer("C2 12 20 00 0E 00 00 00");
  client.answer("01 01 02 03 04 05 06 07");
  EXPECT_EQ(client.answer("80 12 20 00 00 00 06 06"), "");
  EXPECT_EQ(client.client.result(), AbortCode::hardware);
}

struct WrongAnswer {
  const char* after;   ///< preceding answers
  const char* answer;  ///< the wrong one
  AbortCode code;
};

TEST(SdoBlockClientUpload, AbortsWhatDoesNotFit) {
  const WrongAnswer rows[] = {
      {"", "60 12 20 00 00 00 00 00", AbortCode::command_specifier},
      {"", "C6 12 20 00 65 00 00 00", AbortCode::out_of_memory},  // 101 bytes for a memory of 100
      {"C6 12 20 00 0E 00 00 00", "00 01 02 03 04 05 06 07", AbortCode::sequence_number},
      {"C2 12 20 00 0E 00 00 00|81 01 02 03 04 05 06 07", "C1 00 00 00 00 00 00 00", AbortCode::length_mismatch},
      {"C2 12 20 00 07 00 00 00|81 01 02 03 04 05 06 07", "C2 12 20 00 07 00 00 00", AbortCode::command_specifier},
  };
  for (const WrongAnswer& row : rows) {
    Client client;
    client.upload();
    std::istringstream answers{row.after};
    for (std::string answer; std::getline(answers, answer, '|');) client.answer(answer);
    canopen::sdo::Data abort{0x80, 0x12, 0x20, 0x00};
    canopen::sdo::put_word(abort, static_cast<std::uint32_t>(row.code));
    const std::string sent = client.answer(row.answer);
    EXPECT_EQ(sent, bench::text({.id = 0x605, .size = 8, .data = abort}).substr(4)) << row.answer;
    EXPECT_EQ(client.client.result(), row.code) << row.answer;
  }
}

// Download

TEST(SdoBlockClientDownload, SendsAValueWithItsCrc) {
  Client client;
  const auto bytes = bytes_of("Sample device");
  EXPECT_EQ(client.download(bytes), "C6 12 20 00 0D 00 00 00");
  EXPECT_EQ(client.answer("A4 12 20 00 7F 00 00 00"), "01 53 61 6D 70 6C 65 20 | 82 64 65 76 69 63 65 00");
  EXPECT_EQ(client.answer("A2 02 7F 00 00 00 00 00"), "C5 61 AE 00 00 00 00 00");
  EXPECT_TRUE(client.client.busy());
  EXPECT_EQ(client.answer("A1 00 00 00 00 00 00 00"), "");
  EXPECT_EQ(client.client.result(), canopen::ok);
}

TEST(SdoBlockClientDownload, HasNoCrcForAServerThatSupportsNone) {
  Client client;
  const auto bytes = counting<7>();
  client.download(bytes);
  EXPECT_EQ(client.answer("A0 12 20 00 7F 00 00 00"), "81 01 02 03 04 05 06 07");
  EXPECT_EQ(client.answer("A2 01 7F 00 00 00 00 00"), "C1 00 00 00 00 00 00 00");
}

TEST(SdoBlockClientDownload, SendsSubBlocksOfTheSizeThatTheServerWantsEachTime) {
  Client client;
  const auto bytes = counting<28>();
  client.download(bytes);
  EXPECT_EQ(client.answer("A0 12 20 00 01 00 00 00"), "01 01 02 03 04 05 06 07");
  EXPECT_EQ(client.answer("A2 01 02 00 00 00 00 00"), "01 08 09 0A 0B 0C 0D 0E | 02 0F 10 11 12 13 14 15");
  EXPECT_EQ(client.answer("A2 02 7F 00 00 00 00 00"), "81 16 17 18 19 1A 1B 1C");
}

TEST(SdoBlockClientDownload, SendsTheRestOfASubBlockAgainFromTheFirstSegmentThatWasLost) {
  Client client;
  const auto bytes = counting<16>();
  client.download(bytes);
  client.answer("A4 12 20 00 7F 00 00 00");
  EXPECT_EQ(client.answer("A2 01 7F 00 00 00 00 00"), "01 08 09 0A 0B 0C 0D 0E | 82 0F 10 00 00 00 00 00");
  EXPECT_EQ(client.answer("A2 00 01 00 00 00 00 00"), "01 08 09 0A 0B 0C 0D 0E");
  EXPECT_EQ(client.answer("A2 01 01 00 00 00 00 00"), "81 0F 10 00 00 00 00 00");
  EXPECT_EQ(client.answer("A2 01 01 00 00 00 00 00"), "D5 E5 65 00 00 00 00 00");
}

TEST(SdoBlockClientDownload, GivesUpWhenNothingComesThroughAgainAndAgain) {
  Client client{{.block_transfer = true, .block_threshold = 4, .block_retries = 1}};
  const auto bytes = counting<7>();
  client.download(bytes);
  client.answer("A0 12 20 00 7F 00 00 00");
  EXPECT_EQ(client.answer("A2 00 7F 00 00 00 00 00"), "81 01 02 03 04 05 06 07");
  EXPECT_EQ(client.answer("A2 00 7F 00 00 00 00 00"), "80 12 20 00 03 00 04 05");
}

TEST(SdoBlockClientDownload, GoesOnWhenTheBusHasRoom) {
  Client client;
  const auto bytes = counting<21>();
  client.download(bytes);
  client.bus.room = 1;
  EXPECT_EQ(client.answer("A0 12 20 00 7F 00 00 00"), "01 01 02 03 04 05 06 07");
  EXPECT_EQ(client.client.next_deadline(), client.now);
  client.bus.room = 1;
  EXPECT_EQ(client.pass(1ms), "02 08 09 0A 0B 0C 0D 0E");
  client.bus.room = 10;
  EXPECT_EQ(client.pass(1ms), "83 0F 10 11 12 13 14 15");
  EXPECT_EQ(client.client.next_deadline(), client.now + canopen::Duration{100ms});
}

TEST(SdoBlockClientDownload, FallsBackToSegments) {
  Client client;
  const auto bytes = counting<5>();
  client.download(bytes);
  EXPECT_EQ(client.answer("80 12 20 00 01 00 04 05"), "21 12 20 00 05 00 00 00");
  EXPECT_EQ(client.answer("60 12 20 00 00 00 00 00"), "05 01 02 03 04 05 00 00");
  client.answer("20 00 00 00 00 00 00 00");
  EXPECT_EQ(client.client.result(), canopen::ok);
  EXPECT_EQ(client.download(bytes), "21 12 20 00 05 00 00 00");
}

TEST(SdoBlockClientDownload, FallsBackForThisTransferAfterAGeneralError) {
  Client client;
  const auto bytes = counting<5>();
  client.download(bytes);
  EXPECT_EQ(client.answer("80 12 20 00 00 00 00 08"), "21 12 20 00 05 00 00 00");
  client.answer("80 12 20 00 00 00 00 08");
  EXPECT_EQ(client.client.result(), AbortCode::general);
  EXPECT_EQ(client.download(bytes), "C6 12 20 00 05 00 00 00");
}

TEST(SdoBlockClientDownload, AbortsWhatDoesNotFit) {
  const WrongAnswer rows[] = {
      {"", "A4 12 20 00 00 00 00 00", AbortCode::block_size},
      {"", "A4 12 20 00 80 00 00 00", AbortCode::block_size},
      {"", "60 12 20 00 00 00 00 00", AbortCode::command_specifier},
      {"A4 12 20 00 7F 00 00 00", "A2 03 7F 00 00 00 00 00", AbortCode::sequence_number},
      {"A4 12 20 00 7F 00 00 00", "A2 01 00 00 00 00 00 00", AbortCode::block_size},
      {"A4 12 20 00 7F 00 00 00", "A1 00 00 00 00 00 00 00", AbortCode::command_specifier},
      {"A4 12 20 00 7F 00 00 00|A2 02 7F 00 00 00 00 00", "A2 02 7F 00 00 00 00 00", AbortCode::command_specifier},
  };
  for (const WrongAnswer& row : rows) {
    Client client;
    const auto bytes = counting<14>();
    client.download(bytes);
    std::istringstream answers{row.after};
    for (std::string answer; std::getline(answers, answer, '|');) client.answer(answer);
    client.answer(row.answer);
    EXPECT_EQ(client.client.result(), row.code) << row.answer;
    EXPECT_FALSE(client.client.busy());
  }
}

TEST(SdoBlockClientDownload, IgnoresTheConfirmationOfAnEarlierOneBeforeItHasBegun) {
  Client client;
  const auto bytes = counting<7>();
  client.download(bytes);
  EXPECT_EQ(client.answer("A2 01 7F 00 00 00 00 00"), "");
  EXPECT_EQ(client.answer("A1 00 00 00 00 00 00 00"), "");
  EXPECT_EQ(client.answer("A4 12 20 00 7F 00 00 00"), "81 01 02 03 04 05 06 07");
}

}  // namespace
