/// SDO access to entries of a remote node, for commands.
#pragma once

#include <canopen/base/abort_code.hpp>
#include <canopen/can/node_id.hpp>
#include <canopen/sdo/sdo_client.hpp>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "online/live_bus.hpp"

namespace edsc {

enum class SdoEnd : std::uint8_t {
  done,
  refused,    ///< the device aborted the transfer
  no_answer,  ///< the device did not send a frame of the transfer within the timeout
  broken,     ///< the response violates the protocol, or is too long
};

/// An abort with another entry than that of the transfer. CiA 301 does not define this, so it does not end the
/// transfer.
struct ForeignAbort {
  std::uint16_t index = 0;
  std::uint8_t sub_index = 0;
  canopen::AbortCode code = canopen::ok;
};

struct SdoOutcome {
  SdoEnd end = SdoEnd::done;
  canopen::AbortCode code = canopen::ok;
  std::vector<std::uint8_t> bytes;            ///< of an upload
  bool size_told = true;                      ///< false: not all of the four bytes may belong to the value
  std::uint32_t waited_ms = 0;                ///< for each response
  std::optional<ForeignAbort> foreign_abort;  ///< received before the end
  std::string block_failure;                  ///< why a block transfer failed, if a segmented one followed
  std::size_t max_bytes = 0;                  ///< the limit that the value exceeds; 0: none

  [[nodiscard]] bool done() const { return end == SdoEnd::done; }
};

/// Why the transfer failed: `refused by the device: 0602 0000h, object does not exist`.
[[nodiscard]] std::string failure_text(const SdoOutcome& outcome);

/// `0602 0000h, object does not exist`
[[nodiscard]] std::string abort_text(canopen::AbortCode code);

enum class SdoTransfer : std::uint8_t {
  segmented,  ///< expedited up to four bytes
  block,      ///< segmented if the device does not support block transfer, or if it fails
};

struct SdoSettings {
  unsigned timeout_ms = 500;
  std::size_t max_bytes = std::size_t{16} << 20;  ///< of an upload of a variable-length data type
};

/// The transferred bytes and the total, 0 if unknown.
using SdoProgress = std::function<void(std::size_t done, std::size_t total)>;

/// Collects the bytes of an upload, up to a limit, since the device determines the length.
class UploadBuffer {
 public:
  explicit UploadBuffer(std::size_t limit) : limit_{limit} {}

  /// Accepts all bytes of the segment, or none with an abort code.
  [[nodiscard]] canopen::AbortCode append(std::span<const std::uint8_t> piece);
  void clear() { bytes_.clear(); }

  [[nodiscard]] std::size_t size() const { return bytes_.size(); }
  [[nodiscard]] std::size_t limit() const { return limit_; }
  [[nodiscard]] std::vector<std::uint8_t> take() { return std::move(bytes_); }

 private:
  std::size_t limit_;
  std::vector<std::uint8_t> bytes_;
};

/// One SDO server of one node. Throws Interrupted after aborting the transfer, and BusLost.
class SdoAccess {
 public:
  SdoAccess(LiveBus& bus, canopen::NodeId node, SdoSettings settings);

  /// `type_size`: bytes of a fixed-length data type. If a device sends many more, or more than
  /// `SdoSettings::max_bytes`, the transfer is aborted with 0607 0012h or 0504 0005h.
  [[nodiscard]] SdoOutcome upload(std::uint16_t index, std::uint8_t sub_index,
                                  SdoTransfer transfer = SdoTransfer::segmented, const SdoProgress& progress = {},
                                  std::optional<std::size_t> type_size = std::nullopt);
  [[nodiscard]] SdoOutcome download(std::uint16_t index, std::uint8_t sub_index, std::span<const std::uint8_t> value,
                                    SdoTransfer transfer = SdoTransfer::segmented, const SdoProgress& progress = {});

  [[nodiscard]] canopen::NodeId node() const { return node_; }

  /// The number of boot-up messages of the node that were received during transfers.
  [[nodiscard]] unsigned boot_ups() const { return boot_ups_; }

  /// Applies to the next transfers.
  void set_timeout(unsigned milliseconds) { settings_.timeout_ms = milliseconds; }

 private:
  using Client = canopen::SdoClient<LiveBus>;

  template <class Begin>
  SdoOutcome transfer(SdoTransfer how, std::uint32_t entry, Begin begin);
  SdoOutcome finish(std::uint32_t entry, bool block);
  void take_frames(canopen::Duration span);

  LiveBus& bus_;
  canopen::NodeId node_;
  SdoSettings settings_;
  Client client_;          ///< the only client of the SDO, since it must recognize late responses
  bool no_block_ = false;  ///< the device did not answer a block transfer
  unsigned boot_ups_ = 0;
};

}  // namespace edsc
