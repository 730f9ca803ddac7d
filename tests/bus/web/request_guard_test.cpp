/// The requests that the web server answers.
#include "web/request_guard.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace edsc {
namespace {

constexpr const char* token = "0123456789abcdef";

WebRequest request(std::string host, std::string origin = "") {
  return {"GET", std::move(host), std::move(origin), "", token};
}

TEST(RequestGuard, HostsOfAServerForThisComputer) {
  const RequestGuard guard{{"127.0.0.1", 8080}, token};
  for (const char* host : {"127.0.0.1:8080", "localhost:8080", "[::1]:8080", "127.9.9.9:8080", "LocalHost:8080"}) {
    EXPECT_EQ(guard.check(request(host)), 200) << host;
  }
  for (const char* host :
       {"", ":8080", "127.0.0.1", "127.0.0.1:80", "127.0.0.1:80801", "evil.example:8080", "127.0.0.1.evil.example:8080",
        "localhost.evil.example:8080", "192.168.0.5:8080", "[fe80::1]:8080", "127.0.0.1:8080:8080", "[127.0.0.1:8080",
        "[127.0.0.1]:8080", "[localhost]:8080"}) {
    EXPECT_EQ(guard.check(request(host)), 421) << host;
  }
}

TEST(RequestGuard, HostsOfAServerForOtherComputers) {
  const RequestGuard any{{"0.0.0.0", 8080}, token};
  EXPECT_EQ(any.check(request("192.168.0.5:8080")), 200);
  EXPECT_EQ(any.check(request("[fe80::1]:8080")), 200);
  EXPECT_EQ(any.check(request("localhost:8080")), 200);
  EXPECT_EQ(any.check(request("rebound.example:8080")), 421);
  const std::string address_and_more{"192.168.0.5\0.example:8080", 25};
  EXPECT_EQ(any.check(request(address_and_more)), 421);
  const RequestGuard named{{"bench.example", 80}, token};
  EXPECT_EQ(named.check(request("bench.example")), 200);
  EXPECT_EQ(named.check(request("bench.example:80")), 200);
  EXPECT_EQ(named.check(request("other.example")), 421);
}

TEST(RequestGuard, NamesAreNotCaseSensitive) {
  const RequestGuard guard{{"Bench.Example", 8080}, token};
  EXPECT_EQ(guard.check(request("bench.example:8080")), 200);
  EXPECT_TRUE(RequestGuard::is_loopback("LOCALHOST"));
}

TEST(RequestGuard, ThePortOfHttpCanBeLeftOut) {
  for (const char* host : {"127.0.0.1", "::1"}) {
    const RequestGuard guard{{host, 80}, token};
    for (const char* own : {"127.0.0.1", "127.0.0.1:80", "[::1]", "[::1]:80"}) {
      EXPECT_EQ(guard.check(request(own)), 200) << own;
    }
    for (const char* other : {"127.0.0.1:", "127.0.0.1:8080", "[::1]:8080", "[::1]x"}) {
      EXPECT_EQ(guard.check(request(other)), 421) << other;
    }
  }
}

TEST(RequestGuard, OriginTokenMethodAndRange) {
  const RequestGuard guard{{"127.0.0.1", 8080}, token};
  EXPECT_EQ(guard.check(request("localhost:8080", "http://localhost:8080")), 200);
  for (const char* origin : {"http://127.0.0.1:8080", "https://localhost:8080", "http://localhost", "null"}) {
    EXPECT_EQ(guard.check(request("localhost:8080", origin)), 403) << origin;
  }
  for (const char* wrong : {"", "0123456789abcde", "0123456789abcdeg", "0123456789abcdef0"}) {
    WebRequest one = request("localhost:8080");
    one.token = wrong;
    EXPECT_EQ(guard.check(one), 403) << wrong;
  }
  for (const char* method : {"POST", "HEAD", "OPTIONS", "get"}) {
    WebRequest one = request("localhost:8080");
    one.method = method;
    EXPECT_EQ(guard.check(one), 405) << method;
  }
  WebRequest part = request("localhost:8080");
  part.range = "bytes=0-";
  EXPECT_EQ(guard.check(part), 416);
}

TEST(RequestGuard, TokensDiffer) {
  std::set<std::string> tokens;
  for (int i = 0; i < 1000; ++i) tokens.insert(random_token());
  EXPECT_EQ(tokens.size(), 1000U);
  EXPECT_EQ(tokens.begin()->size(), 64U);
}

TEST(RequestGuard, UrlsOfIpv6AreInBrackets) {
  EXPECT_EQ((RequestGuard{{"::1", 8080}, token}.url()), "http://[::1]:8080/?token=0123456789abcdef");
}

}  // namespace
}  // namespace edsc
