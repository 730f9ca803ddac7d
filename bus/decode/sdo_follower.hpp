/// Tracks the SDO transfers of one server: expedited, segmented and block transfer (CiA 301, 7.2.4.3.3 to 7.2.4.3.17).
#pragma once

#include <array>
#include <bitset>
#include <canopen/sdo/sdo_protocol.hpp>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "decode/message.hpp"
#include "decode/node_model.hpp"

namespace edsc {

class SdoFollower {
 public:
  /// Maximum bytes of a value that are stored; of longer values, only the length is known.
  static constexpr std::size_t max_kept = 1024;

  /// Decodes a frame of the client or server into `message`. `model` may be null: objects then have no names. The
  /// values of the message are valid until the next frame.
  void follow(const TimedFrame& frame, bool from_client, const NodeModel* model, Message& message);

  /// Whether a transfer is in progress.
  [[nodiscard]] bool open() const { return phase_ != Phase::idle; }
  /// `read of 1008h:00 Manufacturer device name after 7 bytes`
  [[nodiscard]] std::string description() const;

  /// The complete value of the finished transfer. Empty if it is too long to be stored, or if part of it is missing.
  [[nodiscard]] std::span<const std::uint8_t> whole_value() const;

 private:
  enum class Phase : std::uint8_t {
    idle,
    asked,           ///< initiated by the client
    segments,        ///< initiated by both
    block_answered,  ///< block upload: waiting for the client to start
    block_running,   ///< a sub-block
    block_last,      ///< the last segment has been sent
    block_ending,    ///< all segments are confirmed
    block_ended,     ///< the sender has ended the transfer
  };

  /// The present frame, and what it means.
  struct Step {
    const TimedFrame& timed;
    const canopen::sdo::Data& data;
    const NodeModel* model;
    Message& message;
  };

  void request(const Step& step);
  void response(const Step& step);
  void report(SdoFault fault, const Step& step) const;
  [[nodiscard]] bool continues(bool expected, std::string_view what, const Step& step) const;
  void part(std::string_view what, const Step& step) const;
  void begin(const Step& step, bool download, std::string_view how = {});
  void announce(bool has_size, const Step& step);
  void abort(const Step& step);
  void finish(const Step& step);

  // Expedited and segmented transfer
  [[nodiscard]] std::span<const std::uint8_t> expedited_value(const canopen::sdo::Data& data) const;
  void initiate_download(const Step& step);
  void upload_answer(const Step& step);
  void segment(const Step& step, bool from_client);
  void segment_requested(const Step& step);
  void segment_confirmed(const Step& step);

  // Block transfer: sdo_block_follower.cpp
  void initiate_block_download(const Step& step);
  void initiate_block_upload(const Step& step);
  void block_upload_command(const Step& step);
  void block_download_answer(const Step& step);
  void block_upload_answer(const Step& step);
  void block_segment(const Step& step);
  void block_confirmed(const Step& step);
  void block_end(const Step& step);
  void flush_held(std::size_t bytes);

  void append(std::span<const std::uint8_t> bytes);
  void put_value(Message& message) const;
  void put_bytes(std::uint32_t offset, std::uint32_t bytes, bool last, const Step& step) const;
  void put_duration(const Step& step) const;
  void put_transfer(TransferStep transfer_step, Message& message) const;

  Phase phase_ = Phase::idle;
  bool begun_ = false;  ///< the log has the start of a transfer
  bool download_ = false;
  bool expedited_ = false;
  bool last_seen_ = false;
  bool asked_ = false;    ///< segmented transfer: the server has not answered the last request or segment
  bool complete_ = true;  ///< no part is missing from the log
  bool client_crc_ = false, crc_used_ = false;
  bool toggle_ = false;  ///< of the next segment
  std::uint16_t index_ = 0;
  std::uint8_t sub_index_ = 0;
  std::optional<std::int64_t> start_;  ///< us
  std::optional<std::uint32_t> announced_;
  std::uint32_t total_ = 0;
  std::uint16_t crc_ = 0;
  const NodeModel* model_ = nullptr;
  const Entry* entry_ = nullptr;  ///< null if it is in no known EDS
  std::string name_;              ///< `Manufacturer device name`
  std::string label_;             ///< `1008h:00 Manufacturer device name`
  std::vector<std::uint8_t> kept_;

  // A sub-block is used when it is confirmed: until then its segments may be repeated.
  static constexpr std::size_t segment_bytes = canopen::sdo::segment_bytes;
  std::array<std::uint8_t, canopen::sdo::largest_block * segment_bytes> block_{};
  std::bitset<canopen::sdo::largest_block + 1> seen_;
  std::uint8_t highest_ = 0;  ///< sequence number
  bool holds_ = false;        ///< the last confirmed segment, which the end of a block transfer truncates
  std::array<std::uint8_t, segment_bytes> held_{};
};

}  // namespace edsc
