/// Entries of a remote node over SDO, from a command.
#pragma once

#include <canopen/abort_code.hpp>
#include <canopen/node_id.hpp>
#include <canopen/sdo_client.hpp>
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
  refused,    ///< by the device: its abort ended the transfer
  no_answer,  ///< the device sent nothing that belongs to the transfer for the timeout
  broken,     ///< what the device answered is against the protocol, or too long
};

/// An abort that names another entry than that of the transfer. CiA 301 has none, so it does not end the transfer.
struct ForeignAbort {
  std::uint16_t index = 0;
  std::uint8_t sub_index = 0;
  canopen::AbortCode code = canopen::ok;
};

struct SdoOutcome {
  SdoEnd end = SdoEnd::done;
  canopen::AbortCode code = canopen::ok;
  std::vector<std::uint8_t> bytes;  ///< of an upload
  bool size_told = true;            ///< false: some of the four bytes may be none of the value's
  std::optional<ForeignAbort> foreign_abort;  ///< that came before the end
  std::string block_failure;                  ///< why a block transfer broke, where segments came after it
  std::size_t max_bytes = 0;                  ///< the bound that the value exceeds; 0: it does not

  [[nodiscard]] bool done() const { return end == SdoEnd::done; }
};

/// Why there is no value: `refused by the device: 0602 0000h, object does not exist`.
[[nodiscard]] std::string failure_text(const SdoOutcome& outcome);

/// `0602 0000h, object does not exist`
[[nodiscard]] std::string abort_text(canopen::AbortCode code);

enum class SdoTransfer : std::uint8_t {
  segmented,  ///< expedited where four bytes do
  block,      ///< by segments when the device has no block transfer, and again by segments when it breaks
};

struct SdoSettings {
  unsigned timeout_ms = 500;
  std::size_t max_bytes = std::size_t{16} << 20;  ///< of an upload whose type has no fixed size
};

/// How many bytes have gone, of how many; 0 where that is not known.
using SdoProgress = std::function<void(std::size_t done, std::size_t total)>;

/// The bytes of an upload, up to a limit: the device decides how long its answer is.
class UploadBuffer {
 public:
  explicit UploadBuffer(std::size_t limit) : limit_{limit} {}

  /// Takes all bytes of the piece or, with the abort code, none.
  [[nodiscard]] canopen::AbortCode append(std::span<const std::uint8_t> piece);
  void clear() { bytes_.clear(); }

  [[nodiscard]] std::size_t size() const { return bytes_.size(); }
  [[nodiscard]] std::size_t limit() const { return limit_; }
  [[nodiscard]] std::vector<std::uint8_t> take() { return std::move(bytes_); }

 private:
  std::size_t limit_;
  std::vector<std::uint8_t> bytes_;
};

/// One SDO server of one node. Throws Interrupted, when the transfer has been aborted, and BusLost.
class SdoAccess {
 public:
  SdoAccess(LiveBus& bus, canopen::NodeId node, SdoSettings settings);

  /// `type_size`: bytes of the data type, where that is fixed. A device that sends many more than that, or more than
  /// `SdoSettings::max_bytes`, gets an abort: 0607 0012h or 0504 0005h.
  [[nodiscard]] SdoOutcome upload(std::uint16_t index, std::uint8_t sub_index,
                                  SdoTransfer transfer = SdoTransfer::segmented, const SdoProgress& progress = {},
                                  std::optional<std::size_t> type_size = std::nullopt);
  [[nodiscard]] SdoOutcome download(std::uint16_t index, std::uint8_t sub_index, std::span<const std::uint8_t> value,
                                    SdoTransfer transfer = SdoTransfer::segmented, const SdoProgress& progress = {});

  [[nodiscard]] canopen::NodeId node() const { return node_; }

  /// For the next transfers.
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
  Client client_;          ///< the only one: an SDO has one client, which knows the answers that may still come
  bool no_block_ = false;  ///< the device was silent where a block transfer was asked for
};

}  // namespace edsc
