/// The image of examples/firmware for a device whose DOMAINs have no memory.
#include "firmware_parts.hpp"

template <>
struct SelectParts<EDSC_DEVICE, false> {
  using type = canopen::Composition<EDSC_DEVICE, canopen::without<EDSC_OBJECTS::blob_1k, EDSC_OBJECTS::blob_8k>>;
};

#include "main.cpp"
