/// SDO transfers to many nodes: a queue for each node, served by a few clients.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "canopen/base/abort_code.hpp"
#include "canopen/base/clock.hpp"
#include "canopen/base/result.hpp"
#include "canopen/can/frame.hpp"
#include "canopen/can/node_id.hpp"
#include "canopen/sdo/sdo_client.hpp"

namespace canopen {

/// How a transfer ended.
struct SdoAnswer {
  AbortCode result = ok;               ///< `ok`, or the abort code of either side
  std::span<const std::uint8_t> data;  ///< bytes that an upload has read into memory
  bool size_known = true;              ///< false: the server did not indicate how many of these bytes are the value
};

/// One transfer to a node. Memory, sink and source are used until `done` has been called, which happens exactly once.
/// `done` may submit new requests; it must not cancel any.
struct SdoRequest {
  std::uint16_t index = 0;
  std::uint8_t sub_index = 0;
  bool download = false;
  std::span<std::uint8_t> memory{};       ///< upload without a sink: destination
  std::span<const std::uint8_t> bytes{};  ///< download without a source: source
  SdoSink sink{};
  SdoSource source{};
  void (*done)(void* context, NodeId node, const SdoAnswer& answer) = nullptr;
  void* context = nullptr;
  Duration timeout{0};  ///< without a response; 0: that of the queue
};

/// Transfers to one node run one after the other, in the order of `submit`; up to `Clients` nodes are served at the
/// same time. All requests to the default SDO of a node must use the same queue: two clients of one SDO receive each
/// other's responses. At most `Capacity` requests wait; further ones are rejected with 060A 0023h.
template <Bus BusType, std::size_t Clients, std::size_t Capacity>
class SdoQueue {
 public:
  constexpr explicit SdoQueue(BusType& can_bus, SdoClientOptions options = {}) : bus_{can_bus}, options_{options} {}
  SdoQueue(const SdoQueue&) = delete;
  SdoQueue& operator=(const SdoQueue&) = delete;

  /// Appends a request to the queue of a node. 060A 0023h: `Capacity` requests are waiting; `done` is not called.
  Result<void> submit(NodeId node, const SdoRequest& request, TimePoint now) {
    if (count_ == Capacity) return AbortCode::no_resource;
    waiting_[count_++] = {request, node};
    if (!ending_) begin_waiting(now);
    return ok;
  }

  /// Ends all queued requests to a node with this code and calls their `done`; the running one is aborted at
  /// the server.
  void cancel(NodeId node, AbortCode code, TimePoint now) {
    end_all(node, code, now, [code, now](Client& client) { client.cancel(code, now); });
  }

  /// Reports that the boot-up message of a node has arrived: the reset has discarded its requests. Ends all of them
  /// with 0800 0022h.
  void node_reset(NodeId node, TimePoint now) {
    end_all(node, AbortCode::device_state, now, [now](Client& client) { client.server_reset(now); });
  }

  /// Accepts a frame of the bus.
  void on_frame(const Frame& frame, TimePoint now) {
    for (Channel& channel : channels_) {
      if (channel.client) channel.client->on_frame(frame, now);
    }
    finish(now);
  }

  /// Sends and times out transfers. Call it at `next_deadline()`, and when the bus has room again.
  void on_time(TimePoint now) {
    for (Channel& channel : channels_) {
      if (channel.client) channel.client->on_time(now);
    }
    finish(now);
  }

  /// Returns when `on_time` is next due; with `wanted`, also when a client becomes free for another node.
  [[nodiscard]] std::optional<TimePoint> next_deadline(bool wanted = false) const {
    std::optional<TimePoint> next;
    const auto consider = [&next](std::optional<TimePoint> other) {
      if (other && (!next || *other < *next)) next = other;
    };
    for (const Channel& channel : channels_) {
      if (!channel.client) continue;
      consider(channel.client->next_deadline());
      if ((wanted || count_ != 0) && !channel.client->busy()) consider(channel.client->settled_at());
    }
    return next;
  }

  /// Whether a request to this node is waiting or running.
  [[nodiscard]] bool busy(NodeId node) const {
    const Channel* const channel = find(node);
    if (channel != nullptr && channel->running) return true;
    return std::any_of(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(count_),
                       [node](const Waiting& waiting) { return waiting.node == node; });
  }

  /// Whether a request to this node would start at once.
  [[nodiscard]] bool ready(NodeId node, TimePoint now) const {
    if (busy(node)) return false;
    if (find(node) != nullptr) return true;
    return std::any_of(channels_.begin(), channels_.end(), [now](const Channel& channel) { return channel.free(now); });
  }

  /// Returns the number of waiting requests, without running ones and those with this context.
  [[nodiscard]] std::size_t waiting(const void* without = nullptr) const {
    const auto end = waiting_.begin() + static_cast<std::ptrdiff_t>(count_);
    return static_cast<std::size_t>(std::count_if(waiting_.begin(), end, [without](const Waiting& waiting) {
      return without == nullptr || waiting.request.context != without;
    }));
  }

 private:
  using Client = SdoClient<BusType>;

  struct Waiting {
    SdoRequest request{};
    NodeId node{};
  };

  /// A client stays with its node until another node needs it, because it knows which responses may still arrive.
  struct Channel {
    std::optional<Client> client{};
    SdoRequest request{};
    NodeId node{};
    bool running = false;

    [[nodiscard]] bool free(TimePoint now) const { return !running && (!client || client->settled(now)); }
  };

  [[nodiscard]] const Channel* find(NodeId node) const {
    for (const Channel& channel : channels_) {
      if (channel.client && channel.node == node) return &channel;
    }
    return nullptr;
  }

  /// Returns the channel that may start a request to this node now; null if none may.
  [[nodiscard]] Channel* channel_for(NodeId node, TimePoint now) {
    if (const Channel* const own = find(node)) {
      Channel& channel = channels_[static_cast<std::size_t>(own - channels_.data())];
      return channel.running || channel.client->busy() ? nullptr : &channel;
    }
    Channel* best = nullptr;
    for (Channel& channel : channels_) {
      if (channel.free(now) && (best == nullptr || (best->client && !channel.client))) best = &channel;
    }
    if (best != nullptr) {
      best->client.emplace(bus_, node, options_);
      best->node = node;
    }
    return best;
  }

  /// Starts waiting requests, in order, as far as nodes and clients are free.
  void begin_waiting(TimePoint now) {
    for (std::size_t i = 0; i < count_;) {
      Channel* const channel = channel_for(waiting_[i].node, now);
      if (channel == nullptr) {
        ++i;
        continue;
      }
      channel->request = take(i).request;
      channel->running = true;
      SdoClientOptions options = options_;
      if (channel->request.timeout.count() != 0) options.timeout = channel->request.timeout;
      channel->client->set_options(options);
      begin(*channel->client, channel->request, now);
    }
  }

  static void begin(Client& client, const SdoRequest& request, TimePoint now) {
    const std::uint16_t index = request.index;
    const std::uint8_t sub_index = request.sub_index;
    if (request.download) {
      (void)(request.source.give != nullptr ? client.download(index, sub_index, request.source, now)
                                            : client.download(index, sub_index, request.bytes, now));
    } else {
      (void)(request.sink.take != nullptr ? client.upload(index, sub_index, request.sink, now)
                                          : client.upload(index, sub_index, request.memory, now));
    }
  }

  /// Removes a request from the queue.
  [[nodiscard]] Waiting take(std::size_t i) {
    const Waiting taken = waiting_[i];
    --count_;
    for (; i < count_; ++i) waiting_[i] = waiting_[i + 1];
    return taken;
  }

  /// Reports the transfers that have ended, and starts the next ones.
  void finish(TimePoint now) {
    for (Channel& channel : channels_) {
      if (!channel.running || channel.client->busy()) continue;
      report(channel, {channel.client->result(), channel.client->data(), channel.client->size_known()});
    }
    begin_waiting(now);
  }

  static void report(Channel& channel, const SdoAnswer& answer) {
    const SdoRequest request = channel.request;
    channel.running = false;
    if (request.done != nullptr) request.done(request.context, channel.node, answer);
  }

  template <class End>
  void end_all(NodeId node, AbortCode code, TimePoint now, End end) {
    std::size_t left = count_;
    ending_ = true;
    for (Channel& channel : channels_) {
      if (!channel.client || channel.node != node) continue;
      end(*channel.client);
      if (channel.running) report(channel, {code, {}, true});
    }
    for (std::size_t i = 0; left > 0 && i < count_; --left) {
      if (waiting_[i].node != node) {
        ++i;
        continue;
      }
      const Waiting ended = take(i);
      if (ended.request.done != nullptr) ended.request.done(ended.request.context, node, {code, {}, true});
    }
    ending_ = false;
    begin_waiting(now);
  }

  BusType& bus_;
  SdoClientOptions options_;
  std::array<Channel, Clients> channels_{};
  std::array<Waiting, Capacity> waiting_{};
  std::size_t count_ = 0;
  bool ending_ = false;  ///< requests are being ended: none may start
};

}  // namespace canopen
