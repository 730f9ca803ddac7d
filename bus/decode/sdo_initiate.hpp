/// The first frame of an SDO transfer.
#pragma once

#include <canopen/can/frame.hpp>
#include <canopen/sdo/sdo_protocol.hpp>
#include <cstdint>
#include <optional>

namespace edsc {

struct SdoInitiate {
  std::uint16_t index;
  std::uint8_t sub_index;
  bool is_download;
};

/// Returns what the request of a client initiates; nothing for the other frames of a transfer. A segment of a block
/// download can have the bytes of an initiate request: only the state of the transfer distinguishes them.
[[nodiscard]] constexpr std::optional<SdoInitiate> sdo_initiate(const canopen::Frame& request) {
  namespace sdo = canopen::sdo;
  if (request.size < 8) return std::nullopt;
  const std::uint8_t command = request.data[0];
  const SdoInitiate initiate{sdo::index_of(request.data), request.data[3], false};
  const SdoInitiate download{initiate.index, initiate.sub_index, true};
  switch (sdo::client_command(command)) {
    case sdo::ClientCommand::initiate_download: return download;
    case sdo::ClientCommand::initiate_upload: return initiate;
    case sdo::ClientCommand::block_download: return (command & 1U) == 0 ? std::optional{download} : std::nullopt;
    case sdo::ClientCommand::block_upload:
      return static_cast<sdo::BlockUpload>(command & 3U) == sdo::BlockUpload::initiate ? std::optional{initiate}
                                                                                       : std::nullopt;
    default: return std::nullopt;
  }
}

}  // namespace edsc
