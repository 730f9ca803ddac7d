/// Arbitrary bytes from a client of the bus server: each frame in them is valid, and the client's codec writes and
/// reads the same frame.
#include <cstdlib>

#include "canopen/host/socketcand_codec.hpp"
#include "server/socketcand_text.hpp"

namespace {

using namespace edsc;

void require(bool condition) {
  if (!condition) std::abort();
}

/// The text between "<" and ">".
std::string_view inside(std::string_view text) { return text.substr(1, text.size() - 2); }

void check(std::string_view element) {
  require(element.size() <= socketcand::longest_element);
  const auto frame = socketcand::parse_send(element);
  if (!frame) return;
  require(frame->size <= 8 && frame->id <= (frame->extended ? 0x1FFF'FFFFu : 0x7FFu));
  std::array<char, canopen::socketcand::longest_message> sent{};
  const std::size_t size = canopen::socketcand::encode(*frame, sent);
  require(socketcand::parse_send(inside({sent.data(), size})) == frame);
  const auto text = socketcand::received_text(*frame, {1, 2});
  std::string_view received = inside(text);
  static_cast<void>(canopen::socketcand::take_word(received));
  require(canopen::socketcand::decode(received, frame->remote) == frame);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  socketcand::ElementReader reader;
  for (std::size_t i = 0; i < size; ++i) {
    if (reader.take(static_cast<char>(data[i])) == socketcand::ElementReader::Found::element) check(reader.element());
  }
  return 0;
}
