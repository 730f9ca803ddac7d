/// The progress of an SDO transfer after each of its frames (CiA 301, 7.2.4.3).
#include "decode/sdo_follower.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "decode/decoder.hpp"

namespace edsc {
namespace {

struct Step {
  bool request;
  std::initializer_list<std::uint8_t> bytes;
  TransferStep step;
};

constexpr TransferStep part = TransferStep::part, finished = TransferStep::finished, aborted = TransferStep::aborted;

/// Decodes the frames between a client and node 6, and compares the step of each.
void expect_steps(std::string_view name, bool download, const std::vector<Step>& steps) {
  Decoder decoder{{}};
  Message message;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const Step& step = steps[i];
    TimedFrame frame;
    frame.frame.id = step.request ? 0x606 : 0x586;
    frame.frame.size = 8;
    std::ranges::copy(step.bytes, frame.frame.data.begin());
    decoder.decode(frame, message);
    EXPECT_EQ(message.step, step.step) << name << ", frame " << i << ": " << message.text;
    EXPECT_EQ(message.download, download) << name << ", frame " << i;
    EXPECT_EQ(message.index, 0x2002) << name << ", frame " << i;
    EXPECT_EQ(message.sub_index, 1) << name << ", frame " << i;
    EXPECT_EQ(message.text.find("not in the log"), std::string::npos) << name << ", frame " << i << message.text;
  }
  EXPECT_TRUE(decoder.open_transfers().empty()) << name;
}

constexpr bool request = true, response = false, download = true, upload = false;

TEST(SdoFollower, FollowsExpeditedTransfers) {
  expect_steps("download", download,
               {{request, {0x2F, 0x02, 0x20, 0x01, 7}, part}, {response, {0x60, 0x02, 0x20, 0x01}, finished}});
  expect_steps("upload", upload,
               {{request, {0x40, 0x02, 0x20, 0x01}, part}, {response, {0x4F, 0x02, 0x20, 0x01, 7}, finished}});
}

TEST(SdoFollower, FollowsSegmentedTransfers) {
  expect_steps("download", download,
               {{request, {0x21, 0x02, 0x20, 0x01, 9}, part},
                {response, {0x60, 0x02, 0x20, 0x01}, part},
                {request, {0x00, 1, 2, 3, 4, 5, 6, 7}, part},
                {response, {0x20}, part},
                {request, {0x1B, 8, 9}, part},
                {response, {0x30}, finished}});
  expect_steps("upload", upload,
               {{request, {0x40, 0x02, 0x20, 0x01}, part},
                {response, {0x41, 0x02, 0x20, 0x01, 9}, part},
                {request, {0x60}, part},
                {response, {0x00, 1, 2, 3, 4, 5, 6, 7}, part},
                {request, {0x70}, part},
                {response, {0x1B, 8, 9}, finished}});
}

TEST(SdoFollower, FollowsBlockTransfers) {
  expect_steps("download", download,
               {{request, {0xC2, 0x02, 0x20, 0x01, 9}, part},
                {response, {0xA0, 0x02, 0x20, 0x01, 2}, part},
                {request, {0x01, 1, 2, 3, 4, 5, 6, 7}, part},
                {request, {0x82, 8, 9}, part},
                {response, {0xA2, 2, 2}, part},
                {request, {0xD5}, part},
                {response, {0xA1}, finished}});
  expect_steps("upload", upload,
               {{request, {0xA0, 0x02, 0x20, 0x01, 2}, part},
                {response, {0xC2, 0x02, 0x20, 0x01, 9}, part},
                {request, {0xA3}, part},
                {response, {0x01, 1, 2, 3, 4, 5, 6, 7}, part},
                {response, {0x82, 8, 9}, part},
                {request, {0xA2, 2, 2}, part},
                {response, {0xD5}, part},
                {request, {0xA1}, finished}});
}

TEST(SdoFollower, EndsATransferWithAnAbort) {
  expect_steps(
      "by the server", download,
      {{request, {0x2F, 0x02, 0x20, 0x01, 7}, part}, {response, {0x80, 0x02, 0x20, 0x01, 0x02, 0, 1, 6}, aborted}});
  expect_steps("by the client", upload,
               {{request, {0x40, 0x02, 0x20, 0x01}, part},
                {response, {0x41, 0x02, 0x20, 0x01, 9}, part},
                {request, {0x80, 0x02, 0x20, 0x01, 0, 0, 4, 5}, aborted}});
}

}  // namespace
}  // namespace edsc
