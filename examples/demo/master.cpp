#include "master.hpp"

#include <array>

namespace demo {

Master::Master(canopen::VirtualBus& bus) : bus_{bus}, port_{bus.attach()} {
  port_.on_frame = [this](const canopen::Frame& frame, canopen::TimePoint now) { on_frame(frame, now); };
  port_.on_time = [this](canopen::TimePoint now) {
    if (active_ != nullptr) active_->on_time(now);
  };
  port_.next_deadline = [this] { return active_ == nullptr ? std::nullopt : active_->next_deadline(); };
}

void Master::command(canopen::NmtCommand command, canopen::NodeId node) {
  send({.id = canopen::function_code::nmt, .size = 2, .data = {static_cast<std::uint8_t>(command), node.value()}});
}

void Master::on_frame(const canopen::Frame& frame, canopen::TimePoint now) {
  const bool error_control = (frame.id & 0x780) == canopen::function_code::error_control;
  if (error_control && frame.size == 1 && frame.data[0] == 0)
    booted_.insert(static_cast<std::uint8_t>(frame.id & 0x7F));
  if (active_ != nullptr) active_->on_frame(frame, now);
  if (const auto receiver = receivers_.find(frame.id); receiver != receivers_.end()) receiver->second(frame);
}

void Master::send(const canopen::Frame& frame) {
  while (!port_.send(frame)) bus_.run_for(std::chrono::milliseconds{1});
}

canopen::AbortCode Master::run(Client& client) {
  active_ = &client;
  while (client.busy()) bus_.run_for(std::chrono::milliseconds{1});
  active_ = nullptr;
  return last_abort_ = client.result();
}

std::string Master::read_text(canopen::NodeId node, std::uint16_t index, std::uint8_t sub_index) {
  std::array<std::uint8_t, 64> memory{};
  Client client{port_, node, timeout};
  client.upload(index, sub_index, memory, bus_.now());
  if (run(client) != canopen::ok) return "?";
  const auto bytes = client.data();
  const std::string text(bytes.begin(), bytes.end());
  return text.substr(0, text.find('\0'));
}

}  // namespace demo
