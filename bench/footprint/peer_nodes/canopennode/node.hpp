/// A node of CANopenNode with node-ID 5 and the application of drive.hpp: a function for one written object, and an
/// error that is reported.
#pragma once

#include "driver.hpp"

#include <cstdint>

class CanopenNodePeer {
 public:
  // Words of the messages of the error: error register, and the status bit that CANopenNode adds.
  static constexpr std::uint32_t emergency = 0x3002'2320;
  static constexpr std::uint32_t emergency_over = 0x3000'0000;
  static constexpr std::uint32_t error_in_history = 0x3002'2320;

  /// Starts the node as after a reset. Returns whether CANopenNode accepts the object dictionary.
  bool start() {
    constexpr std::uint8_t node_id = 5;
    constexpr std::uint16_t bit_rate = 500;          // kbit/s; the driver ignores it
    constexpr std::uint16_t server_timeout = 1000;   // ms
    constexpr std::uint16_t first_heartbeat = 1000;  // ms
    std::uint32_t erroneous_entry = 0;
    stack_ = CO_new(nullptr, nullptr);
    if (CO_CANinit(stack_, nullptr, bit_rate) != CO_ERROR_NO) return false;
    if (CO_CANopenInit(stack_, nullptr, nullptr, OD, nullptr, 0, first_heartbeat, server_timeout, 0, 0, node_id,
                       &erroneous_entry) != CO_ERROR_NO) {
      return false;
    }
    if (CO_CANopenInitPDO(stack_, stack_->em, OD, node_id, &erroneous_entry) != CO_ERROR_NO) return false;
    OD_extension_init(OD_find(OD, acceleration), &written_);
    CO_CANsetNormalMode(stack_->CANmodule);
    return true;
  }

  void receive(std::uint32_t id, std::uint32_t size, std::uint32_t first, std::uint32_t second) {
    PeerFrame frame{id, size, {.words = {first, second}}};
    peer_driver::dispatch(*stack_->CANmodule, frame);
  }

  /// Processes PDOs and SYNC. `elapsed`: us since the last call.
  void process_pdos(std::uint32_t elapsed) {
    const bool_t is_sync = CO_process_SYNC(stack_, elapsed, nullptr);
    CO_process_RPDO(stack_, is_sync, elapsed, nullptr);
    CO_process_TPDO(stack_, is_sync, elapsed, nullptr);
  }

  /// Processes the SDO server alone. Returns whether it has more segments of a block to send.
  bool process_sdo(std::uint32_t elapsed) {
    return CO_SDOserver_process(stack_->SDOserver, 1, elapsed, nullptr) == CO_SDO_RT_blockUploadInProgress;
  }

  /// Processes all services. Returns whether a reset was requested.
  bool process(std::uint32_t elapsed) {
    const bool is_reset = CO_process(stack_, 0, elapsed, nullptr) != CO_RESET_NOT;
    process_pdos(elapsed);
    return is_reset;
  }

  /// Reports an error while the output stage has one.
  void check(bool is_faulty) {
    constexpr std::uint16_t short_circuit = 0x2320;
    if (is_faulty == is_faulty_) return;
    is_faulty_ = is_faulty;
    if (is_faulty) {
      CO_errorReport(stack_->em, CO_EM_MANUFACTURER_START, short_circuit, 0);
    } else {
      CO_errorReset(stack_->em, CO_EM_MANUFACTURER_START, 0);
    }
  }

 private:
  static constexpr std::uint16_t acceleration = 0x6083;

  static ODR_t write_acceleration(OD_stream_t* stream, const void* bytes, OD_size_t size, OD_size_t* written) {
    const ODR_t result = OD_writeOriginal(stream, bytes, size, written);
    if (result == ODR_OK) ramp() = OD_RAM.x6083;
    return result;
  }
  /// A register of the output stage.
  static volatile std::uint32_t& ramp();

  CO_t* stack_ = nullptr;
  OD_extension_t written_{nullptr, OD_readOriginal, write_acceleration, {}};
  bool is_faulty_ = false;
};

/// The node of the programs.
using PeerNode = CanopenNodePeer;
