/// The values of a device, for bench/footprint/twins.cpp. Its objects are those of tests/fixtures/typed_drive.eds.
#pragma once

#include <canopen/od/object.hpp>
#include <canopen/od/quantity.hpp>
#include <canopen/od/typed_value.hpp>
#include <canopen/pdo/pdo.hpp>
#include <cstdint>
#include <typed_drive/dictionary.hpp>

namespace twins {

namespace od = typed_drive::od;

/// The compiler does not know them.
struct Values {
  std::uint16_t status;
  std::uint16_t control;
  std::int16_t temperature;
  std::int32_t position;
  std::int8_t mode;
  std::uint8_t door;
};

/// An object without its meaning.
template <std::uint16_t Index, class Type>
using Numbers = canopen::Object<Index, 0, Type, canopen::Access::rw, canopen::Mappable::both>;

}  // namespace twins
