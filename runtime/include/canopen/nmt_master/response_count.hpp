/// Counts the SDO requests and responses of one node, so that a response without a request is detected.
#pragma once

#include <cstdint>

#include "canopen/base/clock.hpp"
#include "canopen/sdo/sdo_protocol.hpp"

namespace canopen {

/// An SDO server responds once to each request but an abort (CiA 301, 7.2.4.3). More responses than requests are those
/// of a second node with the node-ID, or responses to another client. A response that is late has its request, so that
/// it is not a fault. Block uploads are not counted, because the server sends many segments for one request.
class ResponseCount {
 public:
  /// Counts a request, of any client. Earlier requests of which no response arrives for the time `forgotten_after` are
  /// no longer expected to be answered.
  void on_request(const sdo::Data& request, TimePoint now, Duration forgotten_after) {
    if (request[0] == sdo::abort_command) return;
    if (now - last_ > forgotten_after) open_ = 0;
    last_ = now;
    const sdo::ClientCommand command = sdo::client_command(request[0]);
    if (command == sdo::ClientCommand::block_upload) open_ = not_counted;
    if (open_ < not_counted) ++open_;
    const bool initiates =
        command == sdo::ClientCommand::initiate_download || command == sdo::ClientCommand::initiate_upload;
    entry_ = initiates ? sdo::multiplexer_of(request) : any_entry;
  }

  /// Counts a response; returns whether it does not have a request.
  [[nodiscard]] bool on_response(const sdo::Data& response) {
    const bool is_other =
        open_ == 1 && entry_ != any_entry && sdo::has_multiplexer(response) && sdo::multiplexer_of(response) != entry_;
    if (open_ == 0 || is_other) return true;
    if (open_ < not_counted) --open_;
    return false;
  }

 private:
  static constexpr std::uint8_t not_counted = 0xFF;
  static constexpr std::uint32_t any_entry = 0xFF;  ///< bits that a multiplexer does not have

  TimePoint last_{};                 ///< request
  std::uint32_t entry_ = any_entry;  ///< of the last request, if it initiates a transfer
  std::uint8_t open_ = 0;            ///< requests without a response
};

}  // namespace canopen
