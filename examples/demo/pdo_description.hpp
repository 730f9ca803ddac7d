/// The layout of a generated PDO as data for output, derived from its type.
#pragma once

#include <canopen/pdo/pdo_list.hpp>
#include <cstdint>
#include <string_view>
#include <vector>

namespace demo {

struct PdoField {
  std::uint16_t index;
  std::uint8_t sub_index;
  unsigned offset;  ///< first bit
  unsigned bits;
};

struct PdoDescription {
  bool transmit;
  std::uint16_t number;
  unsigned bits;
  std::vector<PdoField> fields;
};

template <class Layout>
[[nodiscard]] PdoDescription describe(bool transmit, std::uint16_t number) {
  PdoDescription description{transmit, number, Layout::bits, {}};
  Layout::for_each([&]<class O, std::size_t I> {
    description.fields.push_back({O::index, O::sub_index, Layout::offsets[I], O::bits});
  });
  return description;
}

template <class... Pdos>
void describe_all(canopen::PdoList<Pdos...>, [[maybe_unused]] bool transmit, std::vector<PdoDescription>& out) {
  (out.push_back(describe<Pdos>(transmit, Pdos::number)), ...);
}

/// The PDOs of a device: RPDOs, then TPDOs.
template <class Device>
[[nodiscard]] std::vector<PdoDescription> describe_pdos() {
  std::vector<PdoDescription> descriptions;
  describe_all(typename Device::Rpdos{}, false, descriptions);
  describe_all(typename Device::Tpdos{}, true, descriptions);
  return descriptions;
}

}  // namespace demo
