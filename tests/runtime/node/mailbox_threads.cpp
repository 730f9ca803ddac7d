/// A thread posts ten million values, of three objects of several widths, while the node runs in another thread, under
/// ThreadSanitizer: no value is torn or older than one before it, and the last one arrives. `mailbox_threads
/// [VALUES]`: of each object.
#include <canopen/node.hpp>
#include <canopen/node/mailbox.hpp>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <sample/device.hpp>
#include <thread>

#include "support/omitting.hpp"

namespace {

namespace od = sample::od;

struct NoBus {
  bool send(const canopen::Frame&) { return true; }
};

using Text = od::octet_string_value::type;

canopen::Mailbox<od::integer32_value, od::unsigned64_value, od::octet_string_value> mailbox;

/// Both halves follow from the number, so that a torn value is noticed.
std::uint64_t wide(std::uint32_t number) { return std::uint64_t{~number} << 32 | number; }
Text text(std::uint32_t number) {
  Text result;
  result.size = static_cast<std::uint16_t>(8 + number % 8);
  const std::uint32_t words[] = {number, ~number, number * 3, number ^ 0x5555'5555};
  std::memcpy(result.bytes.data(), words, sizeof words);
  return result;
}
std::uint32_t number_of(const Text& value) {
  std::uint32_t number = 0;
  std::memcpy(&number, value.bytes.data(), sizeof number);
  return number;
}

}  // namespace

int main(int argument_count, char** arguments) {
  const std::uint32_t values =
      argument_count > 1 ? static_cast<std::uint32_t>(std::strtoul(arguments[1], nullptr, 10)) : 3'400'000;
  NoBus bus;
  auto node = bench::make_node<sample::Device>(bus, canopen::NodeId{5}, canopen::values_from(mailbox));
  node.start(canopen::TimePoint{});
  std::thread interrupt{[values] {
    for (std::uint32_t i = 1; i <= values; ++i) {
      mailbox.post<od::integer32_value>(static_cast<std::int32_t>(i));
      mailbox.post<od::unsigned64_value>(wide(i));
      mailbox.post<od::octet_string_value>(text(i));
    }
  }};
  std::uint32_t last[3] = {};
  std::uint64_t different = 0;
  bool torn = false;
  bool older = false;
  while (last[0] != values || last[1] != values || last[2] != values) {
    if (!node.next_deadline()) {
      std::this_thread::yield();
      continue;
    }
    node.on_time(canopen::TimePoint{});
    const std::uint64_t wide_value = node.get<od::unsigned64_value>();
    const Text text_value = node.get<od::octet_string_value>();
    const std::uint32_t numbers[3] = {static_cast<std::uint32_t>(node.get<od::integer32_value>()),
                                      static_cast<std::uint32_t>(wide_value), number_of(text_value)};
    const Text expected = text(numbers[2]);
    torn = torn || (numbers[1] != 0 && wide_value != wide(numbers[1])) ||
           (numbers[2] != 0 && (text_value.size != expected.size || text_value.bytes != expected.bytes));
    for (int i = 0; i < 3; ++i) {
      older = older || numbers[i] < last[i];
      different += numbers[i] != last[i];
      last[i] = numbers[i];
    }
    if (torn || older) break;
  }
  interrupt.join();
  std::printf("%u posts of 3 objects: %llu values set%s%s\n", values, static_cast<unsigned long long>(different),
              torn ? ", a value is torn" : "", older ? ", a value is older than one before" : "");
  return torn || older ? 1 : 0;
}
