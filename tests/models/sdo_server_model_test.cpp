/// A node of the runtime and a model of CiA 301 receive the same SDO requests: the model must allow each answer, byte
/// by byte, and the values must be the same afterwards. In each state of the model, all 256 command bytes are tried
/// with each multiplexer and with data of every kind; random walks follow.
#include "sdo_server_model.hpp"

#include <gtest/gtest.h>
#include <canopen/node.hpp>

#include <cstdlib>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "sdo_server_pair.hpp"

namespace {

using model::Data;
using sdo_pair::Pair;

Data request(unsigned command, std::uint32_t multiplexer, std::uint32_t word = 0) {
  Data data{static_cast<std::uint8_t>(command), static_cast<std::uint8_t>(multiplexer >> 8),
            static_cast<std::uint8_t>(multiplexer >> 16), static_cast<std::uint8_t>(multiplexer)};
  for (unsigned i = 0; i < 4; ++i) data[4 + i] = static_cast<std::uint8_t>(word >> 8 * i);
  return data;
}

using Path = std::vector<Data>;

/// The requests that lead to each state of the model: a search through all possible next requests.
std::map<std::string, Path> states(Pair& pair) {
  Path initiates;
  for (const std::uint32_t entry : {0x200000u, 0x200200u, 0x200400u, 0x200700u, 0x200800u, 0x200A00u, 0x200F00u}) {
    for (const std::uint32_t size : {1u, 4u, 8u, 14u, 16u, 900u}) {
      initiates.push_back(request(0x21, entry, size));
      initiates.push_back(request(0xC6, entry, size));
      initiates.push_back(request(0xC2, entry, size));
    }
    initiates.push_back(request(0x20, entry));
    initiates.push_back(request(0xC4, entry));
  }
  for (const std::uint32_t entry :
       {0x100000u, 0x100800u, 0x200000u, 0x200400u, 0x200700u, 0x200800u, 0x200A00u, 0x200B00u, 0x201000u}) {
    initiates.push_back(request(0x40, entry));
    for (const std::uint32_t size : {1u, 2u, 5u, 127u}) {
      initiates.push_back(request(0xA4, entry, size));
      initiates.push_back(request(0xA0, entry, size | 0x2000));
    }
  }
  std::map<std::string, Path> found{{pair.expected.key(), {}}};
  std::vector<Path> open{{}};
  while (!open.empty()) {
    std::vector<Path> next;
    for (const Path& path : open) {
      pair.restart();
      for (const Data& step : path) pair.ask(step);
      std::vector<Path> steps;
      for (const Data& step : path.empty() ? initiates : pair.expected.suggestions()) steps.push_back({step});
      if (pair.expected.phase() == model::SdoServer::Phase::block_download) {
        // To the end of a sub-block, and to the segment before it.
        Path segments;
        for (std::uint8_t number = steps.front().front()[0]; number < 127; ++number)
          segments.push_back({number, 'a', 'b', 'c', 'd', 'e', 'f', 'g'});
        steps.push_back(segments);
        segments.push_back({127, 'a', 'b', 'c', 'd', 'e', 'f', 'g'});
        steps.push_back(segments);
      }
      for (const Path& step : steps) {
        pair.restart();
        pair.begin_log();
        Path longer = path;
        longer.insert(longer.end(), step.begin(), step.end());
        for (const Data& each : longer) pair.ask(each);
        if (found.emplace(pair.expected.key(), longer).second) next.push_back(std::move(longer));
      }
      if (pair.failures > 20) return found;
    }
    open = std::move(next);
  }
  return found;
}

constexpr std::uint32_t multiplexers[] = {0x100000, 0x100001, 0x100800, 0x101801, 0x101804, 0x1FFF00, 0x200000,
                                          0x200100, 0x200200, 0x200300, 0x200400, 0x200500, 0x200600, 0x200700,
                                          0x200800, 0x200900, 0x200A00, 0x200B00, 0x200C00, 0x200D02, 0x200D03,
                                          0x200DFF, 0x200E00, 0x200F00, 0x201000, 0x000000, 0xFFFFFF, 0x201100};
constexpr std::uint32_t words[] = {
    0,    1,    2,      3,          4,          5,          9,          0x7F,       0x80,   300,    301,
    1000, 1001, 0xFFFB, 0xFFFFFFFA, 0x3F800000, 0x3F800001, 0xBF800001, 0x7FC00000, 0x037F, 0x0401, 0xFF00FF01};

bool has_multiplexer(unsigned command) {
  const unsigned specifier = command >> 5;
  return specifier == 1 || specifier == 2 || (specifier == 5 && (command & 3) == 0) ||
         (specifier == 6 && (command & 1) == 0);
}

#ifdef EDSC_SANITIZED
constexpr unsigned thinned = 40;  // divisor of the number of tests; larger with sanitizers
#else
constexpr unsigned thinned = 5;
#endif

void tell(const Pair& pair) { std::printf("%llu requests\n", static_cast<unsigned long long>(pair.requests)); }

TEST(SdoServerModel, EachCommandInEachState) {
  Pair pair;
  const std::map<std::string, Path> all = states(pair);
  std::printf("%zu states of the model\n", all.size());
  for (const auto& state : all) {
    const std::string& key = state.first;
    const Path& path = state.second;
    const auto attempt = [&](const Data& last) {
      pair.restart();
      pair.begin_log();
      for (const Data& step : path) pair.ask(step);
      pair.ask(last);
      if (pair.changed) pair.check_values();
    };
    const unsigned step = path.empty() ? 1 : path.size() > 40 ? 9 * thinned : thinned;
    for (unsigned command = 0; command < 256; ++command) {
      unsigned choice = command;
      if (has_multiplexer(command) && key.front() != '3') {
        for (const std::uint32_t multiplexer : multiplexers) {
          for (std::size_t w = choice++ % step; w < std::size(words); w += path.empty() ? 1 : 5 * step)
            attempt(request(command, multiplexer, words[w]));
        }
      } else {
        for (std::size_t w = choice % step; w < std::size(words); w += step) {
          const std::uint32_t word = words[w];
          attempt(request(command, word << 16 | (word & 0xFF00) | word >> 16, word * 3));
        }
      }
    }
    pair.check_values();
    if (pair.failures != 0) break;
  }
  tell(pair);
}

/// A random walk of requests that mostly fit the state.
void walk(Pair& pair, std::mt19937& random, unsigned steps) {
  const auto upto = [&random](unsigned end) { return static_cast<unsigned>(random() % end); };
  for (unsigned i = 0; i < steps && pair.failures == 0; ++i) {
    const std::vector<Data> next = pair.expected.suggestions();
    const unsigned kind = upto(32);
    Data data{};
    if (!next.empty() && kind < 26) {
      data = next[upto(static_cast<unsigned>(next.size()))];
      if (kind == 0) data[upto(8)] ^= static_cast<std::uint8_t>(1u << upto(8));
    } else {
      for (std::uint8_t& byte : data) byte = static_cast<std::uint8_t>(random());
      constexpr std::uint8_t commands[] = {0x20, 0x21, 0x22, 0x23, 0x27, 0x2B, 0x2F, 0x40, 0x40, 0x40, 0xA0, 0xA4,
                                           0xA4, 0xC0, 0xC2, 0xC4, 0xC6, 0x60, 0x00, 0xA1, 0xA2, 0xC1, 0xE0};
      if (kind != 31) {
        data = request(commands[upto(std::size(commands))], multiplexers[upto(std::size(multiplexers))],
                       words[upto(std::size(words))]);
      }
      if (kind < 30 && pair.expected.phase() == model::SdoServer::Phase::block_download) data[0] = 0x80;
    }
    pair.ask(data);
    if (i % 16 == 0) pair.check_values();
  }
}

std::uint32_t seed() {
  const char* const given = std::getenv("EDSC_MODEL_SEED");
  const std::uint32_t seed = given != nullptr ? static_cast<std::uint32_t>(std::strtoul(given, nullptr, 0)) : 20261122u;
  std::printf("seed %u; EDSC_MODEL_SEED is another one\n", seed);
  return seed;
}

TEST(SdoServerModel, RandomWalks) {
  Pair pair;
  std::mt19937 random{seed()};
  for (unsigned i = 0; i < 10'000 / thinned && pair.failures == 0; ++i) {
    pair.restart();
    pair.begin_log();
    walk(pair, random, 500);
  }
  tell(pair);
}

TEST(SdoServerModel, RandomWalksOnABusWithLittleRoom) {
  Pair pair;
  std::mt19937 random{seed()};
  for (unsigned i = 0; i < 1000 / thinned && pair.failures == 0; ++i) {
    pair.restart();
    pair.begin_log();
    pair.room = 1 + i % 3;
    walk(pair, random, 200);
  }
  tell(pair);
}

TEST(SdoServerModel, ASilentClientEndsEachTransfer) {
  Pair pair;
  const std::map<std::string, Path> all = states(pair);
  for (const auto& [key, path] : all) {
    pair.restart();
    pair.begin_log();
    for (const Data& step : path) pair.ask(step);
    pair.be_silent();
    pair.ask(request(0x40, 0x100000));
    pair.check_values();
    if (pair.failures != 0) break;
  }
  tell(pair);
}

TEST(SdoServerModel, OtherFramesDoNotDisturb) {
  Pair pair;
  std::mt19937 random{seed()};
  const std::map<std::string, Path> all = states(pair);
  for (const auto& [key, path] : all) {
    pair.restart();
    pair.begin_log();
    for (const Data& step : path) pair.ask(step);
    // An SDO request has eight bytes (7.2.4.3), is a data frame and has the CAN-ID of 1200h:01.
    for (std::uint8_t size = 0; size < 8; ++size) {
      pair.ignore({.id = 0x605, .size = size, .data = {0x40, 0x00, 0x10}});
      pair.ignore({.id = 0x605, .size = size, .data = {0x80, 0x00, 0x10}});
    }
    pair.ignore({.id = 0x605, .size = 8, .remote = true});
    pair.ignore({.id = 0x605, .size = 8, .extended = true, .data = {0x80}});
    for (const std::uint32_t id : {0x604u, 0x606u, 0x585u, 0x600u}) pair.ignore({.id = id, .size = 8, .data = {0x80}});
    for (const Data& step : pair.expected.suggestions()) {
      pair.ask(step);
      break;
    }
    if (pair.failures != 0) break;
  }
  tell(pair);
}

}  // namespace
