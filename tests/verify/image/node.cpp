/// A complete node as in firmware. DEVICE and DEVICE_HEADER name the device; with STORED it stores its parameters.
#include "support/omitting.hpp"

#include <canopen/node.hpp>
#include DEVICE_HEADER

extern "C" bool can_send(const canopen::Frame&);
extern "C" bool can_receive(canopen::Frame&);
extern "C" std::uint32_t microseconds();

namespace {

struct Can {
  bool send(const canopen::Frame& frame) { return can_send(frame); }
};
Can can;

}  // namespace

#ifdef STORED
#include <canopen/storage/flash_storage.hpp>

extern "C" bool flash_erase(std::uint8_t page);
extern "C" bool flash_write(std::uint8_t page, std::uint32_t offset, const std::uint8_t* words, std::size_t size);
extern "C" bool flash_read(std::uint8_t page, std::uint32_t offset, std::uint8_t* to, std::size_t size);

struct Flash {
  static constexpr std::uint32_t page_size = 2048;
  static constexpr std::uint32_t word_size = 8;
  bool erase(std::uint8_t page) { return flash_erase(page); }
  bool write(std::uint8_t page, std::uint32_t offset, std::span<const std::uint8_t> words) {
    return flash_write(page, offset, words.data(), words.size());
  }
  bool read(std::uint8_t page, std::uint32_t offset, std::span<std::uint8_t> to) {
    return flash_read(page, offset, to.data(), to.size());
  }
};
Flash flash;
constinit canopen::FlashStorage storage{flash};
constinit auto node = bench::make_node<DEVICE>(can, canopen::NodeId{5}, canopen::stored_in(storage));
#else
constinit auto node = bench::make_node<DEVICE>(can, canopen::NodeId{5});
#endif

int main() {
  node.start(canopen::TimePoint{canopen::Duration{microseconds()}});
  for (;;) {
    canopen::Frame frame;
    const canopen::TimePoint now{canopen::Duration{microseconds()}};
    if (can_receive(frame)) node.on_frame(frame, now);
    node.on_time(now);
  }
}
