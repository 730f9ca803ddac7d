/// The functions that a frame passes through, compiled with -finstrument-functions: of each path its name, then a line
/// for each call with its depth and the address of the function.
#include <array>
#include <canopen/node.hpp>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <device/device.hpp>

#define UNCOUNTED __attribute__((no_instrument_function))

namespace {

struct Call {
  int depth;
  void* function;
};
std::array<Call, 4096> calls;
std::size_t count = 0;
int depth = 0;
bool recording = false;

}  // namespace

extern "C" {
UNCOUNTED void __cyg_profile_func_enter(void* function, void*) {
  if (recording && count < calls.size()) calls[count++] = {++depth, function};
}
UNCOUNTED void __cyg_profile_func_exit(void*, void*) {
  if (recording) --depth;
}
}

namespace {

struct Bus {
  bool send(const canopen::Frame&) {
    ++sent;
    return true;
  }
  int sent = 0;
};

struct Application {
  void written(device::od::drive_6083, std::uint32_t acceleration) { last = acceleration; }
  std::uint32_t last = 0;
};

using Parts = canopen::Composition<device::Device, Application>;
Bus bus;
canopen::Node<Parts, Bus> node{bus};

/// Prints the calls of one path, which must send this number of frames.
template <class Step>
UNCOUNTED void print(const char* name, int frames, const Step& step) {
  const int before = bus.sent;
  count = 0;
  depth = 0;
  recording = true;
  step();
  recording = false;
  std::printf("path %s\n", bus.sent - before == frames ? name : "wrong number of frames");
  for (std::size_t i = 0; i < count; ++i) std::printf("%d %p\n", calls[i].depth, calls[i].function);
}

UNCOUNTED constexpr canopen::TimePoint at(std::uint32_t microseconds) {
  return canopen::TimePoint{canopen::Duration{microseconds}};
}

UNCOUNTED void receive(const char* name, int frames, const canopen::Frame& frame) {
  print(name, frames, [&]() UNCOUNTED { node.on_frame(frame, at(1)); });
}

}  // namespace

UNCOUNTED int main() {
  node.start(canopen::NodeId{5}, {});
  node.on_frame(canopen::make_frame(0x000, 2, {0x0501, 0}), {});  // NMT: start node 5
  node.on_time({});
  receive("SDO download", 1, canopen::make_frame(0x605, 8, {0x0060'8323, 77}));
  if (node.application<Application>().last != 77) return 1;
  receive("SDO upload", 1, canopen::make_frame(0x605, 8, {0x0060'8340, 0}));
  receive("RPDO", 0, canopen::make_frame(0x305, 8, {1, 2}));
  receive("SYNC", 4, canopen::make_frame(0x080, 0, {0, 0}));
  // TPDO 1 becomes event-driven, and is sent once.
  constexpr std::uint8_t event_driven[] = {255};
  if (node.set(0x1800, 2, event_driven) != canopen::ok) return 1;
  node.on_time(at(2));
  print("TPDO", 1, []() UNCOUNTED {
    static_cast<void>(node.set<device::od::drive_6064>(1234));
    node.on_time(at(3));
  });
  return 0;
}
