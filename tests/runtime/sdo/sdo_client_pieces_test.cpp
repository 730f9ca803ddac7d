/// Transfers of the SDO client that are streamed in pieces.
#include <gtest/gtest.h>
#include <canopen/sdo/sdo_client.hpp>

#include <vector>

#include "sdo_client_bench.hpp"
#include "support/bench.hpp"

namespace {

using canopen::AbortCode;
using client_bench::bytes_of;
using client_bench::Client;

TEST(SdoClientPieces, AnUploadGoesToASink) {
  Client client;
  std::vector<std::uint8_t> taken;
  std::vector<bool> lasts;
  auto take = [&](std::uint32_t offset, std::span<const std::uint8_t> bytes, bool last) {
    EXPECT_EQ(offset, taken.size());
    taken.insert(taken.end(), bytes.begin(), bytes.end());
    lasts.push_back(last);
    return canopen::ok;
  };
  EXPECT_TRUE(client.client.upload(0x2012, 0, canopen::sink_of(take), client.now));
  client.answer("C6 12 20 00 0D 00 00 00");
  client.answer("01 53 61 6D 70 6C 65 20");
  client.answer("82 64 65 76 69 63 65 00");
  EXPECT_EQ(lasts.size(), 1u);
  client.answer("C5 61 AE 00 00 00 00 00");
  EXPECT_EQ(taken, bytes_of("Sample device"));
  EXPECT_EQ(lasts, (std::vector<bool>{false, true}));
  EXPECT_TRUE(client.client.data().empty());
}

TEST(SdoClientPieces, ASinkMayEndTheTransfer) {
  Client client{{}};
  auto take = [](std::uint32_t, std::span<const std::uint8_t>, bool) { return AbortCode::not_stored; };
  client.client.upload(0x2012, 0, canopen::sink_of(take), client.now);
  client.take();
  EXPECT_EQ(client.answer("4B 12 20 00 01 02 00 00"), "80 12 20 00 20 00 00 08");
}

auto give_sample_device = [](std::uint32_t offset, std::span<std::uint8_t> bytes) -> canopen::Result<std::uint32_t> {
  const std::string_view rest = std::string_view{"Sample device"}.substr(offset, bytes.size());
  std::copy(rest.begin(), rest.end(), bytes.begin());
  return static_cast<std::uint32_t>(rest.size());
};

TEST(SdoClientPieces, ADownloadComesFromASourceOfUnknownSize) {
  Client client;
  client.client.download(0x2012, 0, canopen::source_of(give_sample_device), client.now);
  EXPECT_EQ(client.take(), "C4 12 20 00 00 00 00 00");
  EXPECT_EQ(client.answer("A4 12 20 00 7F 00 00 00"), "01 53 61 6D 70 6C 65 20 | 82 64 65 76 69 63 65 00");
  EXPECT_EQ(client.answer("A2 01 7F 00 00 00 00 00"), "81 64 65 76 69 63 65 00");
  EXPECT_EQ(client.answer("A2 01 7F 00 00 00 00 00"), "C5 61 AE 00 00 00 00 00");
}

TEST(SdoClientPieces, ADownloadComesFromASourceOfKnownSizeBySegments) {
  Client client{{}};
  client.client.download(0x2012, 0, canopen::source_of(give_sample_device, 13), client.now);
  EXPECT_EQ(client.take(), "21 12 20 00 0D 00 00 00");
  EXPECT_EQ(client.answer("60 12 20 00 00 00 00 00"), "00 53 61 6D 70 6C 65 20");
  EXPECT_EQ(client.answer("20 00 00 00 00 00 00 00"), "13 64 65 76 69 63 65 00");
}

TEST(SdoClientPieces, ASourceThatRunsDryOrFailsEndsTheTransfer) {
  Client client{{}};
  client.client.download(0x2012, 0, canopen::source_of(give_sample_device, 20), client.now);
  client.take();
  client.answer("60 12 20 00 00 00 00 00");
  EXPECT_EQ(client.answer("20 00 00 00 00 00 00 00"), "80 12 20 00 24 00 00 08");
  auto fail = [](std::uint32_t, std::span<std::uint8_t>) {
    return canopen::Result<std::uint32_t>{AbortCode::hardware};
  };
  client.client.download(0x2012, 0, canopen::source_of(fail), client.now);
  client.take();
  EXPECT_EQ(client.answer("60 12 20 00 00 00 00 00"), "80 12 20 00 00 00 06 06");
}

}  // namespace
