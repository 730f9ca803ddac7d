/// Only an SDO client: the test acts as the server. Frames are written as their eight bytes.
#pragma once

#include <gtest/gtest.h>
#include <canopen/sdo/sdo_client.hpp>

#include <array>
#include <chrono>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "support/bench.hpp"

namespace client_bench {

inline constexpr canopen::SdoClientOptions with_blocks{
    .timeout = std::chrono::milliseconds{100}, .block_transfer = true, .block_threshold = 4};

/// A client; the test acts as the server. Frames are written as their eight bytes.
struct Client {
  explicit Client(canopen::SdoClientOptions options = with_blocks) : client{bus, canopen::NodeId{5}, options} {}

  std::string take() {
    std::string text = bus.take();
    for (std::size_t at = 0; (at = text.find("605 ", at)) != std::string::npos;) text.erase(at, 4);
    return text;
  }
  std::string answer(const std::string& bytes) {
    client.on_frame(bench::frame("585 " + bytes), now);
    return take();
  }
  std::string pass(canopen::Duration span) {
    now = now + span;
    client.on_time(now);
    return take();
  }
  std::string upload() {
    EXPECT_TRUE(client.upload(0x2012, 0, memory, now));
    return take();
  }
  std::string download(std::span<const std::uint8_t> bytes) {
    EXPECT_TRUE(client.download(0x2012, 0, bytes, now));
    return take();
  }

  bench::RecordingBus bus;
  std::array<std::uint8_t, 100> memory{};
  canopen::TimePoint now{};
  canopen::SdoClient<bench::RecordingBus> client;
};

inline std::vector<std::uint8_t> bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

}  // namespace client_bench
