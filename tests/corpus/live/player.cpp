/// Plays scripts to generated devices on a virtual bus, in simulated time, and prints what they send. It does not know
/// what is right: live_test.py does.
///
/// Standard input, numbers in hexadecimal except for times:
///     device NAME NODE-ID      a new bus and a new node
///     start                    power-on
///     step NUMBER              printed as `= NUMBER`
///     send CAN-ID [BYTES]      a frame from another participant, and 2 ms for the answers
///     queue CAN-ID [BYTES]     the same without letting time pass
///     remote CAN-ID LENGTH     as send, with a remote frame
///     run MICROSECONDS
///     set INDEX SUB BYTES      by the application; prints `# INDEX SUB ABORT-CODE`
///     emergency CODE, emergency_over
/// A frame is printed as `MICROSECONDS CAN-ID[R][X] BYTES`.
#include <canopen/port/virtual_bus.hpp>

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "live_node.hpp"

namespace live {

bool Bus::send(const canopen::Frame& frame) { return static_cast<canopen::VirtualBus::Endpoint*>(endpoint)->send(frame); }

namespace {

using namespace std::chrono_literals;

std::vector<std::uint8_t> bytes_in(const std::string& text) {
  std::vector<std::uint8_t> bytes;
  for (std::size_t i = 0; i + 1 < text.size(); i += 2) {
    bytes.push_back(static_cast<std::uint8_t>(std::stoul(text.substr(i, 2), nullptr, 16)));
  }
  return bytes;
}

/// A bus with a device, and another participant that sends for the script.
class Life {
 public:
  Life(const Registration& device, std::uint8_t node_id)
      : node_{device.make(connection_, canopen::NodeId{node_id})} {
    canopen::VirtualBus::connect(device_, *node_);
    device_.queue_limit = 1024;
    script_.queue_limit = 1024;
    script_.on_frame = [](const canopen::Frame& frame, canopen::TimePoint now) { print(frame, now); };
  }

  void obey(const std::string& line) {
    std::istringstream words{line};
    std::string command;
    words >> command;
    words >> std::hex;
    if (command == "start") {
      node_->start(bus_.now());
      bus_.run_for(2ms);
    } else if (command == "step") {
      std::string number;
      words >> number;
      std::printf("= %s\n", number.c_str());
    } else if (command == "send" || command == "queue" || command == "remote") {
      send(words, command == "remote");
      if (command != "queue") bus_.run_for(2ms);
    } else if (command == "run") {
      std::uint32_t span = 0;
      words >> std::dec >> span;
      bus_.run_for(canopen::Duration{span});
    } else if (command == "set") {
      unsigned index = 0;
      unsigned sub_index = 0;
      std::string text;
      words >> index >> sub_index >> text;
      const auto code = node_->set(static_cast<std::uint16_t>(index), static_cast<std::uint8_t>(sub_index), bytes_in(text));
      std::printf("# %04X %02X %08X\n", index, sub_index, static_cast<unsigned>(code));
    } else if (command == "emergency") {
      unsigned code = 0;
      words >> code;
      node_->emergency(static_cast<std::uint16_t>(code));
      node_->on_time(bus_.now());
    } else if (command == "emergency_over") {
      node_->emergency_over();
      node_->on_time(bus_.now());
    } else {
      std::printf("! unknown command %s\n", command.c_str());
    }
  }

 private:
  void send(std::istringstream& words, bool remote) {
    canopen::Frame frame{};
    frame.remote = remote;
    words >> frame.id;
    frame.extended = frame.id > 0x7FF;
    if (remote) {
      unsigned length = 0;
      words >> length;
      frame.size = static_cast<std::uint8_t>(length);
    } else {
      std::string text;
      words >> text;
      for (const std::uint8_t byte : bytes_in(text)) frame.data.at(frame.size++) = byte;
    }
    (void)script_.send(frame);
  }

  static void print(const canopen::Frame& frame, canopen::TimePoint now) {
    std::printf("%u %03X%s%s ", static_cast<unsigned>(now.since_start().count()), static_cast<unsigned>(frame.id),
                frame.remote ? "R" : "", frame.extended ? "X" : "");
    for (std::size_t i = 0; i < frame.size && !frame.remote; ++i) std::printf("%02X", frame.data.at(i));
    std::putchar('\n');
  }

  canopen::VirtualBus bus_{1'000'000};
  canopen::VirtualBus::Endpoint& script_ = bus_.attach();
  canopen::VirtualBus::Endpoint& device_ = bus_.attach();
  Bus connection_{&device_};
  std::unique_ptr<LiveNode> node_;
};

int play() {
  std::unique_ptr<Life> life;
  for (std::string line; std::getline(std::cin, line);) {
    if (line.rfind("device ", 0) == 0) {
      std::istringstream words{line};
      std::string name;
      unsigned node_id = 0;
      words >> name >> name >> std::dec >> node_id;
      std::printf("device %s %u\n", name.c_str(), node_id);
      std::fflush(stdout);
      const Registration* device = Registration::first;
      while (device != nullptr && name != device->name) device = device->next;
      if (device == nullptr) return 2;
      life = std::make_unique<Life>(*device, static_cast<std::uint8_t>(node_id));
    } else if (life) {
      life->obey(line);
    }
  }
  return 0;
}

}  // namespace
}  // namespace live

int main() { return live::play(); }
