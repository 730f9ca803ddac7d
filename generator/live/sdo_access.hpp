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

#include "live/live_bus.hpp"

namespace edsc {

enum class SdoEnd : std::uint8_t {
  done,
  refused,    ///< by the device: its abort ended the transfer
  no_answer,  ///< the device sent nothing that belongs to the transfer for the timeout
  broken,     ///< what the device answered is against the protocol, or longer than is bearable
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
};

/// How many bytes have gone, of how many; 0 where that is not known.
using SdoProgress = std::function<void(std::size_t done, std::size_t total)>;

/// The bytes of an upload, up to a limit: the device decides how long its answer is.
class UploadBuffer {
 public:
  static constexpr std::size_t max_upload = 256 * 1024 * 1024;

  explicit UploadBuffer(std::size_t limit = max_upload) : limit_{limit} {}

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

  [[nodiscard]] SdoOutcome upload(std::uint16_t index, std::uint8_t sub_index,
                                  SdoTransfer transfer = SdoTransfer::segmented, const SdoProgress& progress = {});
  [[nodiscard]] SdoOutcome download(std::uint16_t index, std::uint8_t sub_index, std::span<const std::uint8_t> value,
                                    SdoTransfer transfer = SdoTransfer::segmented, const SdoProgress& progress = {});

  [[nodiscard]] canopen::NodeId node() const { return node_; }

 private:
  using Client = canopen::SdoClient<LiveBus>;

  template <class Begin>
  SdoOutcome transfer(SdoTransfer how, std::uint32_t entry, Begin begin);
  SdoOutcome finish(Client& client, std::uint32_t entry);

  LiveBus& bus_;
  canopen::NodeId node_;
  SdoSettings settings_;
  Client segmented_;
  Client block_;
  bool no_block_ = false;  ///< the device was silent where a block transfer was asked for
};

}  // namespace edsc
