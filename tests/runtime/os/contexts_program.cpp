/// The fragments of docs/contexts.md, compiled: values from an interrupt, parameters stored in steps, a lock.
#include <canopen/node.hpp>
#include <canopen/node/locked.hpp>
#include <canopen/node/mailbox.hpp>
#include <canopen/storage/background_storage.hpp>
#include <canopen/storage/flash_storage.hpp>
#include <cstdint>
#include <mutex>
#include <pump/device.hpp>
#include <span>

namespace od = pump::od;
using namespace canopen::literals;

std::uint16_t converted();  // in mbar
canopen::TimePoint now();
void node_task();
void measuring_task();
extern "C" void ADC1_IRQHandler();

namespace {

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

struct Pages {
  static constexpr std::uint32_t page_size = 1024;
  static constexpr std::uint32_t word_size = 8;

  [[nodiscard]] bool ready() const { return true; }
  [[nodiscard]] bool erase(std::uint8_t) { return true; }
  [[nodiscard]] bool write(std::uint8_t, std::uint32_t, std::span<const std::uint8_t>) { return true; }
  [[nodiscard]] bool read(std::uint8_t, std::uint32_t, std::span<std::uint8_t>) const { return true; }
};

Bus bus;
Pages pages;

canopen::Mailbox<od::pressure> measured;
auto sensor = canopen::make_node<pump::Device>(bus, canopen::NodeId{5}, canopen::values_from(measured));

canopen::FlashStorage flash{pages};
canopen::BackgroundStorage<decltype(flash), 512> storage{flash};  // 512: at most this many bytes are stored
auto stored = canopen::make_node<pump::Device>(bus, canopen::NodeId{5}, canopen::stored_in(storage));

std::mutex mutex;  // or another class with lock() and unlock()
canopen::Locked locked{sensor, mutex};

}  // namespace

extern "C" void ADC1_IRQHandler() { measured.post<od::pressure>(canopen::raw(converted())); }

void node_task() {
  locked.on_time(now());
  static_cast<void>(stored);
}
void measuring_task() {
  locked.set<od::pressure>(420_mbar);  // then wakes the task of the node
}
