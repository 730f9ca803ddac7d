/// The PDOs that nodes of a network send to each other, and the values in them.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "network/cob_id_use.hpp"
#include "network/network.hpp"

namespace edsc {

/// A TPDO of a node and an RPDO of another one with the same CAN-ID.
struct PdoLink {
  const CobIdUse* sender = nullptr;
  const CobIdUse* receiver = nullptr;
};

/// The links between these uses, in the order of senders, then receivers.
[[nodiscard]] std::vector<PdoLink> pdo_links(const std::vector<CobIdUse>& uses);

/// An entry of the TPDO that is at the same bits as an entry of the RPDO; positions from 0.
struct LinkedValue {
  std::size_t sent = 0;
  std::size_t taken = 0;
  unsigned first_bit = 0;
};

/// The values of a link without dummies.
[[nodiscard]] std::vector<LinkedValue> linked_values(const PdoLink& link);

/// The name of its signal, or the identifier of an entry in its device: `position`, `write_output_8_bit_1`,
/// `identity_object_vendor_id`.
[[nodiscard]] std::string signal_identifier(const NetworkNode& node, const PdoEntry& entry);

}  // namespace edsc
