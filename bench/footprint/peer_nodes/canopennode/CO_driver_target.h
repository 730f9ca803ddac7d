/// Configuration of CANopenNode for the services of bench/ref.eds, and the frames of the driver.
///
/// PEER_DYNAMIC: mapping of PDOs, their parameters and those of SYNC can be written. PEER_BLOCK: SDO block transfer.
#ifndef CO_DRIVER_TARGET_H
#define CO_DRIVER_TARGET_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define CO_USE_GLOBALS

#ifdef PEER_DYNAMIC
#define CO_CONFIG_GLOBAL_FLAG_OD_DYNAMIC CO_CONFIG_FLAG_OD_DYNAMIC
#define PEER_MAPPING (CO_CONFIG_PDO_OD_IO_ACCESS | CO_CONFIG_FLAG_OD_DYNAMIC)
#else
#define CO_CONFIG_GLOBAL_FLAG_OD_DYNAMIC 0
#define PEER_MAPPING 0
#endif

#define CO_CONFIG_NMT 0
#define CO_CONFIG_HB_CONS 0
#define CO_CONFIG_EM (CO_CONFIG_EM_PRODUCER | CO_CONFIG_EM_HISTORY)
// The application reports its error with the first status bit of the manufacturer.
#define CO_CONFIG_ERR_CONDITION_CURRENT ((em->errorStatusBits[6] & 1U) != 0U)
#define CO_CONFIG_PDO                                                                                            \
  (CO_CONFIG_RPDO_ENABLE | CO_CONFIG_TPDO_ENABLE | CO_CONFIG_RPDO_TIMERS_ENABLE | CO_CONFIG_TPDO_TIMERS_ENABLE | \
   CO_CONFIG_PDO_SYNC_ENABLE | PEER_MAPPING)
#ifdef PEER_BLOCK
#define CO_CONFIG_SDO_SRV (CO_CONFIG_SDO_SRV_SEGMENTED | CO_CONFIG_SDO_SRV_BLOCK | CO_CONFIG_GLOBAL_FLAG_OD_DYNAMIC)
#define CO_CONFIG_SDO_SRV_BUFFER_SIZE 900
#define CO_CONFIG_CRC16 CO_CONFIG_CRC16_ENABLE
#endif
#define CO_CONFIG_TIME 0
#define CO_CONFIG_STORAGE 0
#define CO_CONFIG_LEDS 0
#define CO_CONFIG_LSS 0

#define CO_LITTLE_ENDIAN
#define CO_SWAP_16(x) x
#define CO_SWAP_32(x) x
#define CO_SWAP_64(x) x

typedef uint_fast8_t bool_t;
typedef float float32_t;
typedef double float64_t;

/// Data of a frame, aligned to words.
typedef union {
  uint8_t bytes[8];
  uint32_t words[2];
} PeerData;

/// A received frame.
typedef struct {
  uint32_t id;
  uint32_t size;
  PeerData data;
} PeerFrame;

#define CO_CANrxMsg_readIdent(msg) ((uint16_t)((const PeerFrame*)(msg))->id)
#define CO_CANrxMsg_readDLC(msg) ((uint8_t)((const PeerFrame*)(msg))->size)
#define CO_CANrxMsg_readData(msg) (((const PeerFrame*)(msg))->data.bytes)

typedef struct {
  uint16_t ident;
  uint16_t mask;
  void* object;
  void (*CANrx_callback)(void* object, void* message);
} CO_CANrx_t;

typedef struct {
  uint32_t ident;
  union {
    uint8_t data[8];
    uint32_t words[2];
  };
  uint8_t DLC;
  bool_t bufferFull;
  bool_t syncFlag;
} CO_CANtx_t;

typedef struct {
  void* CANptr;
  CO_CANrx_t* rxArray;
  uint16_t rxSize;
  CO_CANtx_t* txArray;
  uint16_t txSize;
  uint16_t CANerrorStatus;
  bool_t CANnormal;
  uint16_t CANtxCount;
} CO_CANmodule_t;

typedef struct {
  void* addr;
  size_t len;
  uint8_t subIndexOD;
  uint8_t attr;
} CO_storage_entry_t;

// A single thread: nothing is locked.
#define CO_LOCK_CAN_SEND(module)
#define CO_UNLOCK_CAN_SEND(module)
#define CO_LOCK_EMCY(module)
#define CO_UNLOCK_EMCY(module)
#define CO_LOCK_OD(module)
#define CO_UNLOCK_OD(module)
#define CO_FLAG_READ(flag) ((flag) != NULL)
#define CO_FLAG_SET(flag) ((flag) = (void*)1L)
#define CO_FLAG_CLEAR(flag) ((flag) = NULL)

#endif
