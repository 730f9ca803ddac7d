/// A driver of CANopenNode without interrupts. A program that includes this file defines `transmit`.
#pragma once

#include <CANopen.h>
#include <OD.h>
#include <cstdint>

/// Passes a frame to the bus. Returns false if the bus does not accept it now.
bool transmit(std::uint32_t id, std::uint32_t size, const std::uint32_t (&words)[2]);

namespace peer_driver {

constexpr std::uint16_t can_id_mask = 0x7FF;
constexpr std::uint16_t remote_frame = 0x800;

inline bool send_buffer(CO_CANtx_t& buffer) {
  buffer.bufferFull = !transmit(buffer.ident, buffer.DLC, buffer.words);
  return buffer.bufferFull == 0;
}

/// Calls the object of CANopenNode that receives this CAN-ID.
inline void dispatch(CO_CANmodule_t& module, PeerFrame& frame) {
  for (std::uint16_t i = 0; i < module.rxSize; ++i) {
    const CO_CANrx_t& buffer = module.rxArray[i];
    if (((frame.id ^ buffer.ident) & buffer.mask) != 0) continue;
    if (buffer.CANrx_callback != nullptr) buffer.CANrx_callback(buffer.object, &frame);
    return;
  }
}

}  // namespace peer_driver

extern "C" {

void CO_CANsetConfigurationMode(void* /*controller*/) {}

void CO_CANsetNormalMode(CO_CANmodule_t* module) { module->CANnormal = 1; }

void CO_CANmodule_disable(CO_CANmodule_t* /*module*/) {}

CO_ReturnError_t CO_CANmodule_init(CO_CANmodule_t* module, void* controller, CO_CANrx_t rx[], std::uint16_t rx_size,
                                   CO_CANtx_t tx[], std::uint16_t tx_size, std::uint16_t /*bit_rate*/) {
  *module = {controller, rx, rx_size, tx, tx_size, 0, 0, 0};
  for (std::uint16_t i = 0; i < rx_size; ++i) rx[i] = {0, 0xFFFF, nullptr, nullptr};
  for (std::uint16_t i = 0; i < tx_size; ++i) tx[i].bufferFull = 0;
  return CO_ERROR_NO;
}

CO_ReturnError_t CO_CANrxBufferInit(CO_CANmodule_t* module, std::uint16_t index, std::uint16_t id, std::uint16_t mask,
                                    bool_t is_remote, void* object, void (*callback)(void* object, void* message)) {
  if (index >= module->rxSize) return CO_ERROR_ILLEGAL_ARGUMENT;
  const std::uint32_t ident =
      (id & peer_driver::can_id_mask) | (is_remote != 0 ? peer_driver::remote_frame : std::uint32_t{0});
  const std::uint32_t compared = (mask & peer_driver::can_id_mask) | peer_driver::remote_frame;
  module->rxArray[index] = {static_cast<std::uint16_t>(ident), static_cast<std::uint16_t>(compared), object, callback};
  return CO_ERROR_NO;
}

CO_CANtx_t* CO_CANtxBufferInit(CO_CANmodule_t* module, std::uint16_t index, std::uint16_t id, bool_t /*is_remote*/,
                               std::uint8_t size, bool_t is_synchronous) {
  if (index >= module->txSize) return nullptr;
  CO_CANtx_t& buffer = module->txArray[index];
  buffer.ident = id & peer_driver::can_id_mask;
  buffer.DLC = size;
  buffer.bufferFull = 0;
  buffer.syncFlag = is_synchronous;
  return &buffer;
}

CO_ReturnError_t CO_CANsend(CO_CANmodule_t* module, CO_CANtx_t* buffer) {
  if (buffer->bufferFull != 0) return CO_ERROR_TX_OVERFLOW;
  if (module->CANtxCount != 0) {
    buffer->bufferFull = 1;
    ++module->CANtxCount;
  } else if (!peer_driver::send_buffer(*buffer)) {
    ++module->CANtxCount;
  }
  return CO_ERROR_NO;
}

void CO_CANclearPendingSyncPDOs(CO_CANmodule_t* module) {
  for (std::uint16_t i = 0; i < module->txSize && module->CANtxCount != 0; ++i) {
    CO_CANtx_t& buffer = module->txArray[i];
    if (buffer.bufferFull == 0 || buffer.syncFlag == 0) continue;
    buffer.bufferFull = 0;
    --module->CANtxCount;
  }
}

/// Sends the frames that wait.
void CO_CANmodule_process(CO_CANmodule_t* module) {
  for (std::uint16_t i = 0; i < module->txSize && module->CANtxCount != 0; ++i) {
    CO_CANtx_t& buffer = module->txArray[i];
    if (buffer.bufferFull == 0) continue;
    if (!peer_driver::send_buffer(buffer)) return;
    --module->CANtxCount;
  }
}

}  // extern "C"
