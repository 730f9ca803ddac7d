/// The bytes of SDO frames, for client and server (CiA 301, 7.2.4.3.3 to 7.2.4.3.17).
#pragma once

#include <array>
#include <cstdint>
#include <cstring>

namespace canopen::sdo {

using Data = std::array<std::uint8_t, 8>;

/// Client command specifier: bits 5..7 of byte 0.
enum class ClientCommand : std::uint8_t {
  download_segment = 0,
  initiate_download = 1,
  initiate_upload = 2,
  upload_segment = 3,
  abort = 4,
  block_upload = 5,
  block_download = 6,
  reserved = 7,
};

/// Server command specifier: bits 5..7 of byte 0.
enum class ServerCommand : std::uint8_t {
  upload_segment = 0,
  download_segment = 1,
  initiate_upload = 2,
  initiate_download = 3,
  abort = 4,
  block_download = 5,
  block_upload = 6,
  reserved = 7,
};

inline constexpr std::uint8_t size_indicated = 0x01;  ///< initiate: s
inline constexpr std::uint8_t expedited = 0x02;       ///< initiate: e
inline constexpr std::uint8_t last_segment = 0x01;    ///< segment: c
inline constexpr std::uint8_t toggle = 0x10;          ///< segment: t
inline constexpr std::uint8_t abort_command = 0x80;
inline constexpr std::uint32_t segment_bytes = 7;

// Block transfer (CiA 301, 7.2.4.3.9 to 7.2.4.3.16). During a sub-block, bit 7 of byte 0 marks the last segment and the
// bits below it are the sequence number: the only command is then the abort, whose sequence number would be 0.
inline constexpr std::uint8_t crc_supported = 0x04;         ///< initiate: cc, sc
inline constexpr std::uint8_t block_size_indicated = 0x02;  ///< initiate: s
inline constexpr std::uint8_t last_block_segment = 0x80;    ///< segment: c
inline constexpr std::uint8_t sequence_mask = 0x7F;
inline constexpr std::uint8_t largest_block = 127;  ///< segments per sub-block
inline constexpr std::uint32_t unknown_size = 0xFFFF'FFFF;

/// Subcommand of a block upload request: bits 0..1 of byte 0.
enum class BlockUpload : std::uint8_t { initiate = 0, end = 1, confirm = 2, start = 3 };

// Byte 0 of the other messages of block transfers.
inline constexpr std::uint8_t block_upload_initiate = 0xA0;      ///< client
inline constexpr std::uint8_t block_upload_end_answer = 0xA1;    ///< client
inline constexpr std::uint8_t block_upload_confirm = 0xA2;       ///< client
inline constexpr std::uint8_t block_upload_start = 0xA3;         ///< client
inline constexpr std::uint8_t block_upload_answer = 0xC0;        ///< server
inline constexpr std::uint8_t block_upload_end = 0xC1;           ///< server
inline constexpr std::uint8_t block_download_initiate = 0xC0;    ///< client
inline constexpr std::uint8_t block_download_end = 0xC1;         ///< client
inline constexpr std::uint8_t block_download_answer = 0xA0;      ///< server
inline constexpr std::uint8_t block_download_end_answer = 0xA1;  ///< server
inline constexpr std::uint8_t block_download_confirm = 0xA2;     ///< server
inline constexpr std::uint8_t block_end_mask = 0xE3;             ///< of an end command: all bits but n

[[nodiscard]] constexpr ClientCommand client_command(std::uint8_t byte) {
  return static_cast<ClientCommand>(byte >> 5);
}
[[nodiscard]] constexpr ServerCommand server_command(std::uint8_t byte) {
  return static_cast<ServerCommand>(byte >> 5);
}

[[nodiscard]] constexpr std::uint16_t index_of(const Data& data) {
  return static_cast<std::uint16_t>(data[1] | (data[2] << 8));
}

/// Index and sub-index at their position in bytes 1..3 of a frame.
[[nodiscard]] constexpr std::uint32_t multiplexer(std::uint16_t index, std::uint8_t sub_index) {
  return std::uint32_t{index} << 8 | std::uint32_t{sub_index} << 24;
}
[[nodiscard]] constexpr std::uint32_t multiplexer_of(const Data& data) {
  return std::uint32_t{index_of(data)} << 8 | std::uint32_t{data[3]} << 24;
}

/// Whether a response contains an index and sub-index: initiate responses and aborts.
[[nodiscard]] constexpr bool has_multiplexer(const Data& response) {
  switch (server_command(response[0])) {
    case ServerCommand::initiate_upload:
    case ServerCommand::initiate_download:
    case ServerCommand::abort: return true;
    case ServerCommand::block_upload: return (response[0] & 1) == 0;
    case ServerCommand::block_download: return (response[0] & 3) == 0;
    case ServerCommand::upload_segment:
    case ServerCommand::download_segment:
    case ServerCommand::reserved: return false;
  }
  return false;
}

constexpr void put_multiplexer(Data& data, std::uint16_t index, std::uint8_t sub_index) {
  data[1] = static_cast<std::uint8_t>(index & 0xFF);
  data[2] = static_cast<std::uint8_t>(index >> 8);
  data[3] = sub_index;
}

/// Returns bytes 4..7 as a number: a size or an abort code.
[[nodiscard]] inline std::uint32_t word_of(const Data& data) {
  std::uint32_t word = 0;
  std::memcpy(&word, &data[4], sizeof word);
  return word;
}

inline void put_word(Data& data, std::uint32_t word) { std::memcpy(&data[4], &word, sizeof word); }

}  // namespace canopen::sdo
