#include "replay/response_stream.hpp"

#include <algorithm>
#include <canopen/sdo/sdo_protocol.hpp>

namespace edsc::replay {
namespace {

namespace sdo = canopen::sdo;

bool is_expedited_upload(const canopen::Frame& frame) {
  return frame.size == 8 && sdo::server_command(frame.data[0]) == sdo::ServerCommand::initiate_upload &&
         (frame.data[0] & sdo::expedited) != 0;
}

/// The number of bytes of the value; nothing if the response does not state it.
std::optional<unsigned> stated_size(const canopen::Frame& frame) {
  if ((frame.data[0] & sdo::size_indicated) == 0) return std::nullopt;
  return 4U - (frame.data[0] >> 2 & 3U);
}

/// Whether two expedited responses have the same value. Bytes that do not belong to it are not compared; if only one
/// response states the size, it is the size of both.
bool have_same_value(const canopen::Frame& expected, const canopen::Frame& received) {
  if (!is_expedited_upload(expected) || !is_expedited_upload(received)) return false;
  const std::optional<unsigned> first = stated_size(expected), second = stated_size(received);
  if (first && second && *first != *second) return false;
  constexpr std::size_t command = 1, multiplexer = 3;
  const std::size_t end = command + multiplexer + first.value_or(second.value_or(4));
  return std::equal(expected.data.begin() + command, expected.data.begin() + end, received.data.begin() + command);
}

}  // namespace

std::optional<DifferenceKind> compare(Service service, const StreamFrame& expected, const StreamFrame& received) {
  if (expected.decoded.frame == received.decoded.frame) return std::nullopt;
  if (service != Service::sdo) return DifferenceKind::content;
  if (have_same_value(expected.decoded.frame, received.decoded.frame)) return std::nullopt;
  const bool differs = expected.is_abort != received.is_abort || expected.abort_code != received.abort_code;
  return differs ? DifferenceKind::abort_code : DifferenceKind::value;
}

}  // namespace edsc::replay
