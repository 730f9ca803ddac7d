/// Node-ID and bit rate of a node that is configured by LSS, in separate flash pages.
#pragma once

#include <array>
#include <canopen/can/node_id.hpp>
#include <canopen/lss/lss_handler.hpp>
#include <canopen/lss/lss_protocol.hpp>
#include <canopen/storage/flash_storage.hpp>
#include <cstdint>

#include "board.hpp"

/// The port of canopen::configured_by_lss. The bit rate is only stored: a serial line does not have one of a CAN bus.
class LssSettings {
 public:
  explicit constexpr LssSettings(board::Flash& flash) : storage_{flash} {}

  /// Loads the stored values. Call it at power-on.
  void open() {
    std::array<std::uint8_t, 3> image{};
    const bool stored = storage_.open() == canopen::StorageState::whole && storage_.size() == image.size();
    if (!stored || !storage_.read(0, image)) return;
    node_id_ = canopen::NodeId{image[0]};
    bit_timing_ = {image[1], image[2]};
  }

  [[nodiscard]] canopen::NodeId node_id() const { return node_id_; }
  [[nodiscard]] canopen::LssBitTiming bit_timing() const { return bit_timing_; }

  [[nodiscard]] canopen::LssError accept(canopen::NodeId) { return canopen::lss::success; }
  [[nodiscard]] canopen::LssError accept(canopen::LssBitTiming) { return canopen::lss::success; }
  [[nodiscard]] canopen::LssError store(canopen::NodeId node_id, canopen::LssBitTiming timing) {
    const std::array<std::uint8_t, 3> image = {node_id.value(), timing.table, timing.index};
    const bool stored = storage_.begin(image.size()) && storage_.write(image) && storage_.commit();
    return stored ? canopen::lss::success : canopen::lss::storage_access_error;
  }
  void stop_communication() {}
  void start_communication(canopen::LssBitTiming) {}

 private:
  canopen::FlashStorage<board::Flash> storage_;
  canopen::NodeId node_id_ = canopen::unconfigured_node_id;
  canopen::LssBitTiming bit_timing_{0, 4};  ///< 125 kbit/s
};
