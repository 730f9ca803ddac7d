/// The SDO transfers of a master on a host: their memory, their requests and how they end.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <list>
#include <span>
#include <utility>
#include <vector>

#include "canopen/base/abort_code.hpp"
#include "canopen/can/node_id.hpp"
#include "canopen/sdo/sdo_queue.hpp"

namespace canopen {

/// Owns the transfers that are in a queue of SDO requests, because a transfer may outlive the call that waits for it if
/// the bus throws.
class MasterTransfers {
 public:
  static constexpr std::size_t max_upload = 16 * 1024 * 1024;  ///< bytes; 0504 0005h: a value is longer

  struct Transfer {
    MasterTransfers* owner = nullptr;
    std::vector<std::uint8_t> bytes;
    NodeId node_id{};
    std::uint16_t index = 0;
    std::uint8_t sub_index = 0;
    bool download = false;
    bool requested = false;  ///< it is in the queue, or has been
    bool over = false;
    bool size_known = true;
    AbortCode result = ok;
    std::size_t size = 0;
    std::function<void(Transfer&)> done;  ///< called after its end; empty: a call is waiting
  };

  /// `ended` is called at the end of each transfer.
  explicit MasterTransfers(std::function<void(Transfer&)> ended) : ended_{std::move(ended)} {}
  MasterTransfers(const MasterTransfers&) = delete;
  MasterTransfers& operator=(const MasterTransfers&) = delete;

  [[nodiscard]] Transfer& add(NodeId node_id, std::uint16_t index, std::uint8_t sub_index,
                              std::function<void(Transfer&)> done = {}) {
    Transfer& transfer = transfers_.emplace_back();
    transfer.owner = this;
    transfer.node_id = node_id;
    transfer.index = index;
    transfer.sub_index = sub_index;
    transfer.done = std::move(done);
    return transfer;
  }

  void remove(Transfer& transfer) {
    transfers_.remove_if([&transfer](const Transfer& other) { return &other == &transfer; });
  }

  /// The transfer of a call that waits for it. If the bus throws, a transfer that has not ended is kept until it ends.
  struct Awaited {
    explicit Awaited(Transfer& awaited) : transfer{awaited} {}
    Awaited(const Awaited&) = delete;
    Awaited& operator=(const Awaited&) = delete;
    ~Awaited() {
      if (transfer.over || !transfer.requested) {
        transfer.owner->remove(transfer);
      } else {
        transfer.done = [](Transfer&) {};
      }
    }

    Transfer& transfer;
  };

  /// Returns a request that reads a value of any length.
  [[nodiscard]] static SdoRequest upload(Transfer& transfer) {
    SdoRequest request = request_of(transfer);
    request.sink.context = &transfer;
    request.sink.take = [](void* context, std::uint32_t, std::span<const std::uint8_t> bytes, bool) {
      std::vector<std::uint8_t>& value = static_cast<Transfer*>(context)->bytes;
      if (bytes.size() > max_upload - value.size()) return AbortCode::out_of_memory;
      value.insert(value.end(), bytes.begin(), bytes.end());
      return ok;
    };
    return request;
  }

  /// Returns a request that reads a value of up to `size` bytes.
  [[nodiscard]] static SdoRequest upload(Transfer& transfer, std::size_t size) {
    transfer.bytes.resize(size);
    SdoRequest request = request_of(transfer);
    request.memory = transfer.bytes;
    return request;
  }

  /// Returns a request that writes a copy of these bytes.
  [[nodiscard]] static SdoRequest download(Transfer& transfer, std::span<const std::uint8_t> bytes) {
    transfer.bytes.assign(bytes.begin(), bytes.end());
    transfer.download = true;
    SdoRequest request = request_of(transfer);
    request.download = true;
    request.bytes = transfer.bytes;
    return request;
  }

 private:
  [[nodiscard]] static SdoRequest request_of(Transfer& transfer) {
    SdoRequest request;
    request.index = transfer.index;
    request.sub_index = transfer.sub_index;
    request.context = &transfer;
    request.done = [](void* context, NodeId, const SdoAnswer& answer) {
      Transfer& ended = *static_cast<Transfer*>(context);
      ended.result = answer.result;
      ended.size = answer.data.size();
      ended.size_known = answer.size_known;
      ended.over = true;
      ended.owner->ended_(ended);
    };
    return request;
  }

  std::list<Transfer> transfers_;
  std::function<void(Transfer&)> ended_;
};

}  // namespace canopen
