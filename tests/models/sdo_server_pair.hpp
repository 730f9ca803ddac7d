/// A node of the runtime and the model of an SDO server, which receive the same frames.
#pragma once

#include "sdo_server_model.hpp"
#include "support/omitting.hpp"

#include <gtest/gtest.h>
#include <canopen/node.hpp>
#include <sdo_model_device/device.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace sdo_pair {

namespace od = sdo_model_device::od;

inline constexpr std::size_t file_room = 1000;  // 143 segments: more than a sub-block has

struct Bus {
  std::array<model::Data, 300> sent{};
  std::size_t count = 0;
  bool other = false;  ///< a frame that is not an SDO answer
  unsigned room = 1000;
  bool send(const canopen::Frame& frame) {
    if (room == 0) return false;
    --room;
    if (frame.id != 0x585 || frame.size != 8 || frame.extended || frame.remote || count == sent.size()) {
      other = true;
    } else {
      sent[count++] = frame.data;
    }
    return true;
  }
};

/// The object dictionary of sdo_model_device.eds, written a second time.
inline std::vector<model::Entry> dictionary() {
  const auto text = [](std::string_view string) { return model::Octets(string.begin(), string.end()); };
  const auto number = [](std::uint64_t value, std::size_t size) {
    model::Octets octets(size);
    for (std::size_t i = 0; i < size; ++i) octets[i] = static_cast<std::uint8_t>(value >> 8 * i);
    return octets;
  };
  const model::Type u = model::Type::unsigned_integer;
  const model::Type i = model::Type::signed_integer;
  model::Octets log(901);
  for (std::size_t k = 0; k < log.size(); ++k) log[k] = static_cast<std::uint8_t>(k * 37 >> 3);
  return {
      {0x1000, 0, u, true, false, 4, {}, {}, number(0x5A0000, 4)},
      {0x1001, 0, u, true, false, 1, {}, {}, {0}},
      {0x1008, 0, model::Type::string, true, false, 17, {}, {}, text("Model of a server")},
      {0x1017, 0, u, true, true, 2, {}, {}, {0, 0}},
      {0x1018, 0, u, true, false, 1, {}, {}, {1}},
      {0x1018, 1, u, true, false, 4, {}, {}, {0, 0, 0, 0}},
      {0x2000, 0, u, true, true, 1, {}, {}, {7}},
      {0x2001, 0, u, true, true, 2, 10.0, 1000.0, {100, 0}},
      {0x2002, 0, u, true, true, 4, {}, {}, number(0x01020304, 4)},
      {0x2003, 0, i, true, true, 3, {}, {}, {0xFE, 0xFF, 0xFF}},
      {0x2004, 0, u, true, true, 8, {}, {}, number(0x1122334455667788, 8)},
      {0x2005, 0, model::Type::boolean, true, true, 1, {}, {}, {0}},
      {0x2006, 0, model::Type::real32, true, true, 4, -1.0, 1.0, {0, 0, 0, 0}},
      {0x2007, 0, model::Type::string, true, true, 16, {}, {}, text("text")},
      {0x2008, 0, model::Type::string, true, true, 40, {}, {}, {1, 2, 3}},
      {0x2009, 0, u, false, true, 4, {}, {}, {0, 0, 0, 0}},
      {0x200A, 0, model::Type::domain, true, true, file_room, {}, {}, text("a file of eighteen")},
      {0x200B, 0, model::Type::domain, true, false, log.size(), {}, {}, log},
      {0x200C, 0, u, true, false, 2, {}, {}, {0x34, 0x12}},
      {0x200D, 0, u, true, false, 1, {}, {}, {4}},
      {0x200D, 1, u, true, true, 1, {}, {}, {1}},
      {0x200D, 2, i, true, true, 2, -5.0, 300.0, {0xFB, 0xFF}},
      {0x200D, 4, u, true, false, 2, {}, {}, {0xCD, 0xAB}},
      {0x200E, 0, model::Type::string, false, true, 9, {}, {}, {}},
      {0x200F, 0, model::Type::domain, false, true, 30, {}, {}, {}},
      {0x2010, 0, model::Type::domain, true, false, 0, {}, {}, {}},
  };
}

/// Both servers.
class Pair {
 public:
  Pair() : expected{dictionary()} {
    node.start(now);
    reset_bus();
    first_values = node.values();
    restart();
  }

  /// Makes both idle, with the initial values.
  void restart() {
    ask({0x80});
    node.values() = first_values;
    for (std::size_t i = 0; i < first_entries.size(); ++i) {
      if (first_entries[i].writable) expected.entries()[i].value = first_entries[i].value;
    }
    bind_domains();
    changed = false;
  }

  void ask(const model::Data& request) {
    ++requests;
    reset_bus();
    node.on_frame(canopen::Frame{.id = 0x605, .size = 8, .data = request}, now);
    drain();
    const char* wrong = expected.request(request, {bus.sent.data(), bus.count});
    if (bus.other) wrong = "a server sends SDO answers alone";
    if (wrong == nullptr && expected.written() != nullptr) {
      changed = true;
      if (value_of(*expected.written()) != expected.written()->value)
        wrong = "another value than the one that was written";
    }
    if (model::Entry* const entry = expected.spoilt(); entry != nullptr && wrong == nullptr)
      entry->value = value_of(*entry);
    log.push_back(request);
    if (wrong != nullptr) fail(wrong);
  }

  /// Compares all values.
  void check_values() {
    for (const model::Entry& entry : expected.entries()) {
      if (value_of(entry) == entry.value) continue;
      char text[60];
      std::snprintf(text, sizeof text, "%04X:%02X has changed or has not", unsigned{entry.index},
                    unsigned{entry.sub_index});
      fail(text);
    }
  }

  [[nodiscard]] model::Octets value_of(const model::Entry& entry) {
    std::array<std::uint8_t, 8> scratch{};
    const auto word = canopen::EntryAccess<sdo_model_device::Device>::find(entry.index, entry.sub_index);
    const auto bytes = node.entries().read(word, scratch);
    return {bytes.begin(), bytes.end()};
  }

  void begin_log() { log.clear(); }

  /// Sends a frame that is not a request to this server: it is not answered and has no effect.
  void ignore(const canopen::Frame& frame) {
    reset_bus();
    node.on_frame(frame, now);
    drain();
    if (bus.count != 0 || bus.other) fail("a frame that is not a request is answered");
  }

  /// Lets time pass until the server has no deadline.
  void be_silent() {
    reset_bus();
    for (int i = 0; i < 10; ++i) {
      const auto deadline = node.next_deadline();
      if (!deadline) break;
      if (*deadline > now) now = *deadline;
      node.on_time(now);
    }
    const char* wrong = expected.time_out({bus.sent.data(), bus.count});
    if (bus.other) wrong = "a server sends SDO answers alone";
    if (model::Entry* const entry = expected.spoilt(); entry != nullptr && wrong == nullptr)
      entry->value = value_of(*entry);
    if (wrong != nullptr) fail(wrong);
  }

  /// The number of frames that the bus accepts before the node is called again.
  unsigned room = 1000;

  model::SdoServer expected;
  bool changed = false;
  std::uint64_t requests = 0;
  int failures = 0;

 private:
  void reset_bus() {
    bus.count = 0;
    bus.other = false;
    bus.room = room;
  }

  /// Makes room on the bus until the node has nothing to send.
  void drain() {
    while (bus.room == 0) {
      bus.room = room;
      node.on_time(now);
    }
  }

  void bind_domains() {
    for (model::Entry& entry : expected.entries()) {
      if (entry.type != model::Type::domain || entry.size == 0) continue;
      std::vector<std::uint8_t>& memory = memories[entry.index];
      memory.resize(entry.size);
      std::copy(entry.value.begin(), entry.value.end(), memory.begin());
    }
    node.bind<od::file>(memories[0x200A], first_file_size);
    node.bind<od::update>(memories[0x200F], 0);
    node.bind_constant<od::log>(memories[0x200B]);
    node.bind_constant<od::empty_file>(std::span{&nothing, 0});
  }

  void fail(const char* wrong) {
    if (++failures_of[wrong] > 3) return;
    ++failures;
    std::string text;
    const auto add = [&text](const model::Data& data) {
      for (const std::uint8_t byte : data) {
        char piece[4];
        std::snprintf(piece, sizeof piece, "%02X ", static_cast<unsigned>(byte));
        text += piece;
      }
    };
    for (std::size_t i = log.size() > 12 ? log.size() - 12 : 0; i < log.size(); ++i) {
      text += "\n  > ";
      add(log[i]);
    }
    for (std::size_t i = 0; i < bus.count && i < 4; ++i) {
      text += "\n  < ";
      add(bus.sent[i]);
    }
    ADD_FAILURE() << wrong << text << "\n  (" << bus.count << " answers)";
  }

  canopen::TimePoint now{};
  Bus bus;
  bench::NodeOf<sdo_model_device::Device, Bus> node{bus, canopen::NodeId{5}};
  sdo_model_device::Values first_values{};
  const std::vector<model::Entry> first_entries = dictionary();
  const std::size_t first_file_size = 18;
  std::map<unsigned, std::vector<std::uint8_t>> memories;
  std::uint8_t nothing = 0;
  std::vector<model::Data> log;
  std::map<std::string, int> failures_of;
};

}  // namespace sdo_pair
