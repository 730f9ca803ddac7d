/// The rows that browsers get.
#include "web/live_rows.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

namespace edsc {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

std::string rows_after(LiveRows& rows, std::uint64_t version) {
  const auto update = rows.wait(version, milliseconds{0});
  return update ? update->json : "";
}

TEST(LiveRows, AClientGetsWhatHasChangedSince) {
  LiveRows rows;
  EXPECT_EQ(rows_after(rows, 0), "");
  rows.publish({{"a", "1"}, {"b", "2"}});
  EXPECT_EQ(rows_after(rows, 0), R"({"rows":[1,2]})");
  rows.publish({{"a", "1"}, {"b", "3"}});
  EXPECT_EQ(rows_after(rows, 1), R"({"rows":[3]})");
  rows.publish({{"a", "4"}, {"b", "3"}});
  rows.publish({{"a", "5"}});
  EXPECT_EQ(rows_after(rows, 1), R"({"rows":[5,3]})") << "a slow client gets the newest only";
  EXPECT_EQ(rows_after(rows, 4), "");
  rows.publish({{"c", "6"}}, {"a", "b", "no such key"});
  EXPECT_EQ(rows_after(rows, 0), R"({"rows":[6]})");
}

TEST(LiveRows, NobodyWaitsAfterTheEnd) {
  LiveRows rows;
  std::thread client{[&] { EXPECT_FALSE(rows.wait(0, seconds{600})); }};
  rows.end();
  client.join();
  EXPECT_TRUE(rows.has_ended());
  rows.publish({{"a", "1"}});
  EXPECT_EQ(rows_after(rows, 0), "");
}

/// Clients in threads: each sees only numbers that increase, and at last the last one.
TEST(LiveRows, ClientsInThreads) {
  constexpr int last = 2000;
  LiveRows rows;
  std::vector<std::thread> clients;
  for (int i = 0; i < 4; ++i) {
    clients.emplace_back([&rows] {
      int seen = 0;
      for (std::uint64_t version = 0; seen != last;) {
        const auto update = rows.wait(version, seconds{600});
        ASSERT_TRUE(update);
        ASSERT_GT(update->version, version);
        version = update->version;
        const int number = nlohmann::json::parse(update->json)["rows"][0];
        ASSERT_GT(number, seen);
        seen = number;
      }
    });
  }
  for (int number = 1; number <= last; ++number) rows.publish({{"a", std::to_string(number)}});
  for (std::thread& client : clients) client.join();
}

}  // namespace
}  // namespace edsc
