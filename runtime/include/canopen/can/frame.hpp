/// A CAN frame as the services use it.
#pragma once

#include <array>
#include <bit>
#include <concepts>
#include <cstdint>
#include <cstring>

#include "canopen/base/assume_aligned.hpp"
#include "canopen/can/cob_id.hpp"

namespace canopen {

/// A classic CAN data or remote frame. The data are aligned to four bytes, so that codecs can use whole words.
struct Frame {
  std::uint32_t id = 0;   ///< 11 bits, or 29 with `extended`
  std::uint8_t size = 0;  ///< number of data bytes, 0..8; of a remote frame, the requested length
  bool extended = false;
  bool remote = false;
  alignas(4) std::array<std::uint8_t, 8> data{};

  friend constexpr bool operator==(const Frame& a, const Frame& b) {
    if (a.id != b.id || a.size != b.size || a.extended != b.extended || a.remote != b.remote) return false;
    for (std::uint8_t i = 0; !a.remote && i < a.size; ++i) {
      if (a.data[i] != b.data[i]) return false;
    }
    return true;
  }
};

/// Returns the CAN-ID of a frame in the format of a COB-ID: bit 29 marks an extended one.
[[nodiscard]] constexpr std::uint32_t cob_id_of(const Frame& frame) {
  return frame.id | (frame.extended ? std::uint32_t{0x2000'0000} : 0);
}

/// Returns the CAN-ID of a COB-ID, without the flag bits.
[[nodiscard]] constexpr std::uint32_t can_id_of(std::uint32_t cob_id, bool extended) {
  const unsigned flags = extended ? 3 : 21;
  return cob_id << flags >> flags;
}

/// The interface that a node sends through. `send` returns false if the controller has no room; the frame is
/// then not sent.
template <class Type>
concept Bus = requires(Type& bus, const Frame& frame) {
  { bus.send(frame) } -> std::same_as<bool>;
};

template <class BusType>
inline constexpr bool is_bus = Bus<BusType>;

/// The bus of a node; does not compile if it is not a Bus.
template <class BusType>
struct CheckedBus {
  static constexpr bool is_good = true;
  static_assert(
      is_bus<BusType>,
      "bus: it must have `bool send(const canopen::Frame&)`, which returns false if the controller has no room");
};

/// The data bytes of a frame as two words, in memory order.
struct FrameWords {
  std::uint32_t first = 0;
  std::uint32_t second = 0;
};
static_assert(sizeof(FrameWords) == sizeof Frame::data);

[[nodiscard]] inline FrameWords words_of(const Frame& frame) {
  FrameWords words;
  const std::uint8_t* const data = assume_aligned<4>(frame.data.data());
  std::memcpy(&words.first, data, sizeof words.first);
  std::memcpy(&words.second, data + sizeof words.first, sizeof words.second);
  return words;
}

/// Returns a frame with its data as words: memory is not cleared before it is filled.
[[nodiscard]] inline Frame make_frame(std::uint32_t id, std::uint8_t size, FrameWords words, bool extended = false,
                                      bool remote = false) {
  static_assert(std::endian::native == std::endian::little);
  const auto byte = [](std::uint32_t word, unsigned shift) { return static_cast<std::uint8_t>(word >> shift); };
  return {id,
          size,
          extended,
          remote,
          {byte(words.first, 0), byte(words.first, 8), byte(words.first, 16), byte(words.first, 24),
           byte(words.second, 0), byte(words.second, 8), byte(words.second, 16), byte(words.second, 24)}};
}

/// Sends the first `size` of eight data bytes, given as two words in memory order, with a COB-ID of the dictionary.
template <Bus BusType>
[[nodiscard, gnu::noinline]] bool send_words(BusType& bus, std::uint32_t cob_id, std::uint8_t size, std::uint32_t first,
                                             std::uint32_t second = 0) {
  const bool extended = (cob_id & 0x2000'0000) != 0;
  return bus.send(make_frame(can_id_of(cob_id, extended), size, {first, second}, extended));
}

/// The same for a service with a configurable COB-ID: if it is not usable, nothing is sent, and the result is true.
template <Bus BusType>
[[nodiscard, gnu::noinline]] bool send_configured(BusType& bus, std::uint32_t cob_id, std::uint8_t size,
                                                  std::uint32_t first, std::uint32_t second = 0) {
  return !is_usable(cob_id) || send_words(bus, cob_id, size, first, second);
}

/// The same for bytes at an address that is a multiple of four.
template <Bus BusType>
[[nodiscard]] bool send_data(BusType& bus, std::uint32_t cob_id, std::uint8_t size, const std::uint8_t* data) {
  FrameWords words;
  std::memcpy(&words, assume_aligned<4>(data), sizeof words);
  return send_words(bus, cob_id, size, words.first, words.second);
}

}  // namespace canopen
