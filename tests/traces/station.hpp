/// A node on the bus of a trace, as the player uses it; independent of the device.
#pragma once

#include <array>
#include <canopen/host/memory_storage.hpp>
#include <canopen/node.hpp>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "support/omitting.hpp"
#include "trace.hpp"

namespace trace {

class Station {
 public:
  virtual ~Station() = default;

  virtual void power_on(canopen::TimePoint now) = 0;
  /// Values that are not stored are lost; until power-on only time passes.
  virtual void power_off() = 0;
  virtual void on_frame(const canopen::Frame& frame, canopen::TimePoint now) = 0;
  virtual void on_time(canopen::TimePoint now) = 0;
  [[nodiscard]] virtual std::optional<canopen::TimePoint> next_deadline() const = 0;
  [[nodiscard]] virtual canopen::AbortCode set(std::uint16_t index, std::uint8_t sub_index, const Value& value) = 0;
  virtual void emergency(const Emergency& error) = 0;
  /// A line of input for the application. Returns false if it does not know the line, or without an application.
  [[nodiscard]] virtual bool input([[maybe_unused]] const std::string& line, [[maybe_unused]] canopen::TimePoint now) {
    return false;
  }
  virtual void emergency_over(canopen::ErrorRegister bits) = 0;
  /// Returns the bytes of an object's value, or nothing if the device does not have the object.
  [[nodiscard]] virtual std::optional<std::vector<std::uint8_t>> value(std::uint16_t index, std::uint8_t sub_index) = 0;

  /// The bus that the node sends to; keeps the frames until the player takes them.
  bool send(const canopen::Frame& frame) {
    sent_.push_back(frame);
    return true;
  }

  /// Takes the oldest frame that the node has sent.
  [[nodiscard]] std::optional<canopen::Frame> take() {
    if (sent_.empty()) return std::nullopt;
    const canopen::Frame frame = sent_.front();
    sent_.pop_front();
    return frame;
  }

 private:
  std::deque<canopen::Frame> sent_;
};

/// The settings of LSS. The bus of a trace has no bit rate: all nodes use it except one that is switching.
struct LssMemory {
  canopen::NodeId node_id;
  canopen::LssBitTiming timing;
  bool on_bus = true;

  [[nodiscard]] canopen::LssError accept(canopen::NodeId) { return canopen::lss::success; }
  [[nodiscard]] canopen::LssError accept(canopen::LssBitTiming) { return canopen::lss::success; }
  [[nodiscard]] canopen::LssError store(canopen::NodeId new_node_id, canopen::LssBitTiming new_timing) {
    node_id = new_node_id;
    timing = new_timing;
    return canopen::lss::success;
  }
  [[nodiscard]] canopen::LssBitTiming bit_timing() const { return timing; }
  void stop_communication() { on_bus = false; }
  void start_communication(canopen::LssBitTiming) { on_bus = true; }
};

/// What a power-off does not delete.
struct Memory {
  LssMemory lss;
  canopen::MemoryStorage storage;
};

/// The handlers for stored parameters and LSS, as far as the device has these services.
template <class Device>
[[nodiscard]] auto handlers_of(Memory& memory) {
  const auto storage = [&memory] {
    if constexpr (Device::dictionary.has(0x1010, 1)) {
      return std::tuple{canopen::stored_in(memory.storage)};
    } else {
      return std::tuple{};
    }
  };
  const auto lss = [&memory] {
    if constexpr (requires { Device::lss_options; }) {
      return std::tuple{canopen::configured_by_lss(memory.lss)};
    } else {
      return std::tuple{};
    }
  };
  return std::tuple_cat(storage(), lss());
}

/// A station that runs a generated device.
template <class Device, class Handlers = decltype(handlers_of<Device>(std::declval<Memory&>()))>
class DeviceStation;

template <class Device, class... Handlers>
class DeviceStation<Device, std::tuple<Handlers...>> final : public Station {
 public:
  explicit DeviceStation(canopen::NodeId node_id) { memory_.lss.node_id = node_id; }

  void power_on(canopen::TimePoint now) override {
    std::apply([this](Handlers... handlers) { node_.emplace(*this, memory_.lss.node_id, handlers...); },
               handlers_of<Device>(memory_));
    node_->start(now);
  }
  void power_off() override {
    node_.reset();
    memory_.lss.on_bus = true;
  }
  void on_frame(const canopen::Frame& frame, canopen::TimePoint now) override {
    if (memory_.lss.on_bus) node_->on_frame(frame, now);
  }
  void on_time(canopen::TimePoint now) override {
    if (node_) node_->on_time(now);
  }
  [[nodiscard]] std::optional<canopen::TimePoint> next_deadline() const override {
    return node_ ? node_->next_deadline() : std::nullopt;
  }

  [[nodiscard]] canopen::AbortCode set(std::uint16_t index, std::uint8_t sub_index, const Value& value) override {
    const canopen::entry::Word word = Device::dictionary.find(index, sub_index);
    return node_->set(index, sub_index, value.bytes(canopen::entry::wire_bytes(word)));
  }

  void emergency(const Emergency& error) override { node_->emergency(error.code, error.bits, error.info); }
  void emergency_over(canopen::ErrorRegister bits) override { node_->emergency_over(bits); }

  [[nodiscard]] std::optional<std::vector<std::uint8_t>> value(std::uint16_t index, std::uint8_t sub_index) override {
    const canopen::entry::Word word = Device::dictionary.find(index, sub_index);
    if (word <= canopen::Dictionary::no_sub_index) return std::nullopt;
    std::array<std::uint8_t, 8> scratch{};
    const std::span<const std::uint8_t> bytes = node_->entries().read(word, scratch);
    return std::vector<std::uint8_t>{bytes.begin(), bytes.end()};
  }

 private:
  Memory memory_;
  std::optional<bench::NodeOf<Device, Station, Handlers...>> node_;  ///< empty without power
};

template <class Device>
[[nodiscard]] std::unique_ptr<Station> make_station(canopen::NodeId node_id) {
  return std::make_unique<DeviceStation<Device>>(node_id);
}

}  // namespace trace
