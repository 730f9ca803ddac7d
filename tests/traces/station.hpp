/// A node of a trace's bus: what the player sees of it, whatever its device.
#pragma once

#include <array>
#include <canopen/node.hpp>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "trace.hpp"

namespace trace {

class Station {
 public:
  virtual ~Station() = default;

  virtual void start(canopen::TimePoint now) = 0;
  virtual void on_frame(const canopen::Frame& frame, canopen::TimePoint now) = 0;
  virtual void on_time(canopen::TimePoint now) = 0;
  [[nodiscard]] virtual std::optional<canopen::TimePoint> next_deadline() const = 0;
  [[nodiscard]] virtual canopen::AbortCode set(std::uint16_t index, std::uint8_t sub_index, const Value& value) = 0;
  /// The bytes of an object's value. Nothing when the device has no such object.
  [[nodiscard]] virtual std::optional<std::vector<std::uint8_t>> value(std::uint16_t index, std::uint8_t sub_index) = 0;

  /// The bus that the node sends to: keeps its frames until the player takes them.
  bool send(const canopen::Frame& frame) {
    sent_.push_back(frame);
    return true;
  }

  /// The oldest frame that the node has sent and nobody has taken.
  [[nodiscard]] std::optional<canopen::Frame> take() {
    if (sent_.empty()) return std::nullopt;
    const canopen::Frame frame = sent_.front();
    sent_.pop_front();
    return frame;
  }

 private:
  std::deque<canopen::Frame> sent_;
};

/// A station that runs a generated device.
template <class Device>
class DeviceStation final : public Station {
 public:
  explicit DeviceStation(canopen::NodeId node_id) : node_{*this, node_id} {}

  void start(canopen::TimePoint now) override { node_.start(now); }
  void on_frame(const canopen::Frame& frame, canopen::TimePoint now) override { node_.on_frame(frame, now); }
  void on_time(canopen::TimePoint now) override { node_.on_time(now); }
  [[nodiscard]] std::optional<canopen::TimePoint> next_deadline() const override { return node_.next_deadline(); }

  [[nodiscard]] canopen::AbortCode set(std::uint16_t index, std::uint8_t sub_index, const Value& value) override {
    const canopen::entry::Word word = Device::dictionary.find(index, sub_index);
    return node_.set(index, sub_index, value.bytes(canopen::entry::wire_bytes(word)));
  }

  [[nodiscard]] std::optional<std::vector<std::uint8_t>> value(std::uint16_t index, std::uint8_t sub_index) override {
    const canopen::entry::Word word = Device::dictionary.find(index, sub_index);
    if (word <= canopen::Dictionary::no_sub_index) return std::nullopt;
    std::array<std::uint8_t, 8> scratch{};
    const std::span<const std::uint8_t> bytes = node_.entries().read(word, scratch);
    return std::vector<std::uint8_t>{bytes.begin(), bytes.end()};
  }

 private:
  canopen::Node<Device, Station> node_;
};

template <class Device>
[[nodiscard]] std::unique_ptr<Station> make_station(canopen::NodeId node_id) {
  return std::make_unique<DeviceStation<Device>>(node_id);
}

}  // namespace trace
