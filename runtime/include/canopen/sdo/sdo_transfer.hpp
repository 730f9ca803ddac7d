/// What an SDO client is given: the channel, options, and the source or destination of the bytes of a transfer.
#pragma once

#include <cstdint>
#include <span>

#include "canopen/base/abort_code.hpp"
#include "canopen/base/clock.hpp"
#include "canopen/base/result.hpp"
#include "canopen/can/cob_id.hpp"
#include "canopen/can/node_id.hpp"
#include "canopen/sdo/sdo_protocol.hpp"

namespace canopen {

/// The two COB-IDs of an SDO, as in 1200h or 1280h.
struct SdoChannel {
  CobId request;   ///< client to server
  CobId response;  ///< server to client
};

/// Returns the default SDO of a node.
[[nodiscard]] constexpr SdoChannel default_sdo(NodeId server) {
  return {CobId{std::uint32_t{function_code::sdo_request} + server.value()},
          CobId{std::uint32_t{function_code::sdo_response} + server.value()}};
}

struct SdoClientOptions {
  /// A transfer is aborted with 0504 0000h if the server does not respond for this time. Half a second is longer than
  /// erasing a page of flash, which some servers do before they respond.
  Duration timeout = std::chrono::milliseconds{500};
  /// Values longer than `block_threshold` are transferred in blocks; in segments from then on if the server does not
  /// support block transfer.
  bool block_transfer = false;
  /// Maximum size in bytes of a value that is transferred without blocks.
  std::uint8_t block_threshold = 28;
  /// Segments per sub-block of an upload, 1..127.
  std::uint8_t block_size = sdo::largest_block;
  /// Consecutive sub-blocks without progress that are tolerated; one more ends the transfer with 0504 0003h.
  std::uint8_t block_retries = 3;
  /// Block transfers use a CRC if the server supports it.
  bool crc = true;
};

/// Receives the bytes of an upload that no buffer holds as a whole, each byte once and in order. The last piece of a
/// block upload is passed after its CRC has been checked. An AbortCode other than `ok` ends the transfer.
struct SdoSink {
  AbortCode (*take)(void* context, std::uint32_t offset, std::span<const std::uint8_t> bytes, bool last) = nullptr;
  void* context = nullptr;
};

/// Provides the bytes of a download that no buffer holds as a whole: fills `bytes` and returns how many there are.
/// Fewer bytes than requested end a value of unknown size. A piece that was lost on the bus is requested again.
struct SdoSource {
  Result<std::uint32_t> (*give)(void* context, std::uint32_t offset, std::span<std::uint8_t> bytes) = nullptr;
  void* context = nullptr;
  std::uint32_t size = sdo::unknown_size;  ///< bytes, if known
};

/// Returns a sink that calls `callable(offset, bytes, last)`, which must exist until the transfer has ended.
template <class Function>
[[nodiscard]] SdoSink sink_of(Function& callable) {
  return {[](void* context, std::uint32_t offset, std::span<const std::uint8_t> bytes, bool last) -> AbortCode {
            return (*static_cast<Function*>(context))(offset, bytes, last);
          },
          &callable};
}

/// Returns a source that calls `callable(offset, bytes)`, which must exist until the transfer has ended.
template <class Function>
[[nodiscard]] SdoSource source_of(Function& callable, std::uint32_t size = sdo::unknown_size) {
  return {[](void* context, std::uint32_t offset, std::span<std::uint8_t> bytes) -> Result<std::uint32_t> {
            return (*static_cast<Function*>(context))(offset, bytes);
          },
          &callable, size};
}

}  // namespace canopen
