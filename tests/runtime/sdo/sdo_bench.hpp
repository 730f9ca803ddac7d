/// Only an SDO server with the values of a device: requests and answers as the eight bytes of their frames.
#pragma once

#include <canopen/base/crc16.hpp>
#include <canopen/od/object_store.hpp>
#include <canopen/sdo/sdo_server.hpp>
#include <cstdio>
#include <functional>
#include <sample/device.hpp>
#include <span>
#include <sstream>
#include <string>
#include <vector>

namespace bench {

inline canopen::sdo::Data bytes_of(const std::string& text) {
  std::istringstream words{text};
  canopen::sdo::Data data{};
  std::string word;
  for (std::size_t i = 0; words >> word; ++i) data.at(i) = static_cast<std::uint8_t>(std::stoul(word, nullptr, 16));
  return data;
}

inline std::string text_of(const canopen::sdo::Data& data) {
  std::string text;
  for (const std::uint8_t byte : data) {
    char piece[4];
    std::snprintf(piece, sizeof piece, text.empty() ? "%02X" : " %02X", static_cast<unsigned>(byte));
    text += piece;
  }
  return text;
}

/// The CRC of block transfers: two bytes as in a frame.
inline std::string crc_text(std::span<const std::uint8_t> bytes) {
  std::uint16_t crc = 0;
  for (const std::uint8_t byte : bytes) crc = canopen::crc16_ccitt(crc, byte);
  return text_of({static_cast<std::uint8_t>(crc & 0xFF), static_cast<std::uint8_t>(crc >> 8)}).substr(0, 5);
}

/// The sample device with block transfer.
struct WithBlock : sample::Device {
  static constexpr canopen::DeviceOptions options{.sdo_block_transfer = true};
};

template <class Device>
struct PlainHooks {
  canopen::ObjectStore<Device>& store;
  std::function<canopen::AbortCode(std::uint16_t, std::uint8_t)>& refuse;

  [[nodiscard]] auto entries() const { return store.entries(); }
  [[nodiscard]] canopen::AbortCode before_read(std::uint16_t index, std::uint8_t sub_index) const {
    return refuse ? refuse(index, sub_index) : canopen::ok;
  }
  [[nodiscard]] canopen::AbortCode write(std::uint16_t index, std::uint8_t sub_index, canopen::entry::Word word,
                                         std::span<std::uint8_t> bytes) const {
    const canopen::AbortCode code = refuse ? refuse(index, sub_index) : canopen::ok;
    if (code == canopen::ok) store.entries().write(word, bytes);
    return code;
  }
  void written(std::uint16_t /*index*/, std::uint8_t /*sub_index*/) const {}
  [[nodiscard]] static canopen::AbortCode command(std::uint16_t, std::uint8_t, std::span<const std::uint8_t>) {
    return canopen::AbortCode::not_stored;
  }
};

template <class Device = WithBlock>
class SdoBench {
 public:
  SdoBench() {
    store.reset_application(canopen::NodeId{5});
    store.reset_communication(canopen::NodeId{5});
  }

  [[nodiscard]] PlainHooks<Device> hooks() { return {store, refuse}; }

  /// Returns the answer of the server, with " | " between the frames; at most `most` frames, as if the bus had no
  /// more room.
  std::string ask(const std::string& request, std::size_t most = 1000) {
    server.on_request(bytes_of(request), hooks(), now);
    return take(most);
  }

  std::string pass(canopen::Duration span) {
    now = now + span;
    server.on_time(now);
    return take();
  }

  std::string take(std::size_t most = 1000) {
    std::string text;
    for (; server.has_reply() && most != 0; --most) {
      text += (text.empty() ? "" : " | ") + text_of(server.reply());
      server.reply_sent(hooks(), now);
    }
    return text;
  }

  template <class O>
  void bind(std::span<std::uint8_t> memory, std::size_t size) {
    store.template set<O>({memory.data(), static_cast<std::uint32_t>(size), static_cast<std::uint32_t>(memory.size())});
  }

  canopen::ObjectStore<Device> store;
  canopen::SdoServer<Device> server;
  canopen::TimePoint now{};
  std::function<canopen::AbortCode(std::uint16_t, std::uint8_t)> refuse;
};

}  // namespace bench
