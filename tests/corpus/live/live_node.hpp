/// Nodes of many generated devices behind one interface, so that what is compiled for each device is the node alone.
#pragma once

#include <canopen/node.hpp>

#include <cstdint>
#include <optional>
#include <span>

namespace live {

/// A node's way to the bus; the player says where it leads.
struct Bus {
  bool send(const canopen::Frame& frame);
  void* endpoint;
};

class LiveNode {
 public:
  LiveNode() = default;
  LiveNode(const LiveNode&) = delete;
  LiveNode& operator=(const LiveNode&) = delete;
  virtual ~LiveNode() = default;
  virtual void start(canopen::TimePoint now) = 0;
  virtual void on_frame(const canopen::Frame& frame, canopen::TimePoint now) = 0;
  virtual void on_time(canopen::TimePoint now) = 0;
  [[nodiscard]] virtual std::optional<canopen::TimePoint> next_deadline() const = 0;
  virtual canopen::AbortCode set(std::uint16_t index, std::uint8_t sub_index, std::span<const std::uint8_t> bytes) = 0;
  virtual void emergency(std::uint16_t code) = 0;
  virtual void emergency_over() = 0;
};

template <class Device>
class LiveNodeOf final : public LiveNode {
 public:
  LiveNodeOf(Bus& bus, canopen::NodeId node_id) : node_{bus, node_id} {}
  void start(canopen::TimePoint now) override { node_.start(now); }
  void on_frame(const canopen::Frame& frame, canopen::TimePoint now) override { node_.on_frame(frame, now); }
  void on_time(canopen::TimePoint now) override { node_.on_time(now); }
  [[nodiscard]] std::optional<canopen::TimePoint> next_deadline() const override { return node_.next_deadline(); }
  canopen::AbortCode set(std::uint16_t index, std::uint8_t sub_index, std::span<const std::uint8_t> bytes) override {
    return node_.set(index, sub_index, bytes);
  }
  void emergency(std::uint16_t code) override { node_.emergency(code, canopen::ErrorRegister::generic); }
  void emergency_over() override { node_.emergency_over(canopen::ErrorRegister::generic); }

 private:
  canopen::Node<Device, Bus> node_;
};

/// A device that the player finds by its name. One per device, with static lifetime.
struct Registration {
  using Make = LiveNode* (*)(Bus&, canopen::NodeId);

  Registration(const char* its_name, Make its_make) : name{its_name}, make{its_make}, next{first} { first = this; }

  const char* name;
  Make make;
  Registration* next;
  static inline Registration* first = nullptr;
};

template <class Device>
LiveNode* make(Bus& bus, canopen::NodeId node_id) {
  return new LiveNodeOf<Device>{bus, node_id};
}

}  // namespace live
