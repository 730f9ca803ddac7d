/// Storage that is written in steps, so that a node works while its parameters are stored.
///
///     canopen::FlashStorage flash{pages};
///     canopen::BackgroundStorage<decltype(flash), 512> storage{flash};
///     auto drive = canopen::make_node<Device>(bus, NodeId{5}, canopen::stored_in(storage));
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <span>

#include "canopen/storage/storage.hpp"

namespace canopen {

/// Does nothing before a step.
struct NoWatchdog {
  constexpr void operator()() const {}
};

/// Copies a new image to RAM, up to `Capacity` bytes, and then writes it to another storage: one step begins it, which
/// for flash is the erase of a page, each further one writes up to `StepSize` bytes, and the last one completes it. The
/// image has the values at the time of "save", whatever changes later. The node executes one step in each
/// `on_time`; the SDO response is sent after the last one (CiA 301, 7.5.2.13). `Watchdog` is called before each step.
/// If the other storage has a function `ready`, a step waits until it returns true: it may start an erase in `begin`
/// and return.
template <Storage StorageType, std::uint32_t Capacity, std::uint32_t StepSize = 64, class Watchdog = NoWatchdog>
class BackgroundStorage {
 public:
  static constexpr std::uint32_t capacity = Capacity;

  explicit constexpr BackgroundStorage(StorageType& storage, Watchdog watchdog = {})
      : storage_{storage}, watchdog_{watchdog} {}

  [[nodiscard]] StorageState open() {
    work_ = Work::none;
    failed_ = false;
    return storage_.open();
  }
  [[nodiscard]] std::uint32_t size() const { return storage_.size(); }
  [[nodiscard]] bool read(std::uint32_t position, std::span<std::uint8_t> to) { return storage_.read(position, to); }

  [[nodiscard]] bool begin(std::uint32_t size) {
    if (busy() || size > Capacity) return false;
    size_ = size;
    done_ = 0;
    return true;
  }
  [[nodiscard]] bool write(std::span<const std::uint8_t> bytes) {
    if (bytes.size() > size_ - done_) return false;
    if (!bytes.empty()) std::memcpy(&image_[done_], bytes.data(), bytes.size());
    done_ += static_cast<std::uint32_t>(bytes.size());
    return true;
  }
  /// The image is in RAM: the steps follow.
  [[nodiscard]] bool commit() {
    if (done_ != size_) return false;
    work_ = Work::begin;
    failed_ = false;
    return true;
  }

  /// Whether steps are left.
  [[nodiscard]] bool busy() const { return work_ != Work::none; }
  /// Whether the next step can be executed now.
  [[nodiscard]] bool ready() {
    if constexpr (requires { storage_.ready(); }) return storage_.ready();
    return true;
  }
  /// Whether the last image could not be written: the one before it still exists.
  [[nodiscard]] bool failed() const { return failed_; }

  /// Executes the next step.
  void step() {
    watchdog_();
    switch (work_) {
      case Work::none: return;
      case Work::begin: done_ = 0; return after(storage_.begin(size_), size_ == 0 ? Work::commit : Work::write);
      case Work::write: {
        const std::uint32_t bytes = std::min(StepSize, size_ - done_);
        const bool good = storage_.write({&image_[done_], bytes});
        done_ += bytes;
        return after(good, done_ == size_ ? Work::commit : Work::write);
      }
      case Work::commit: return after(storage_.commit(), Work::none);
    }
  }

  /// Executes all steps that are left, and waits for the other storage between them. If it does not become ready in
  /// `max_polls` calls of its `ready`, in all steps together, the image has failed.
  void finish() {
    for (std::uint32_t polls = 0; busy();) {
      if (ready()) {
        step();
      } else if (polls++ == max_polls) {
        after(false, Work::none);
      } else {
        watchdog_();
      }
    }
  }

 private:
  static constexpr std::uint32_t max_polls = storage_detail::max_polls<StorageType>;
  enum class Work : std::uint8_t { none, begin, write, commit };

  void after(bool good, Work next) {
    failed_ = !good;
    work_ = good ? next : Work::none;
  }

  StorageType& storage_;
  std::uint32_t size_ = 0;  ///< of the new image
  std::uint32_t done_ = 0;  ///< bytes that have been copied, then those that have been written
  Work work_ = Work::none;
  bool failed_ = false;
  [[no_unique_address]] Watchdog watchdog_;
  std::array<std::uint8_t, Capacity> image_{};
};

}  // namespace canopen
