/// Arbitrary text from a socketcand server: a client decodes only well-formed frames and understands the next message.
///
/// An input is the text of the server; after an even first byte it greets the client first.
#include <canopen/host/socketcand_codec.hpp>
#include <string_view>

#include "fuzz.hpp"

namespace edsc::fuzz {
namespace {

using canopen::Frame;
using canopen::SocketcandClient;

void check(const Frame& frame) {
  require(frame.size <= 8, "a frame has eight bytes at most");
  require(frame.id <= (frame.extended ? 0x1FFF'FFFFu : 0x7FFu), "identifiers have 11 or 29 bits");
  std::array<char, canopen::socketcand::longest_message> message;
  const std::size_t size = canopen::socketcand::encode(frame, message);
  require(size <= message.size() && message[size - 1] == '>', "a message has an end");
}

std::optional<Frame> hear(SocketcandClient& client, std::string_view text) {
  std::optional<Frame> last;
  for (const char character : text) {
    const SocketcandClient::State before = client.state();
    last = client.on_character(character, {});
    if (last) {
      require(before == SocketcandClient::State::open, "frames come from an open bus");
      check(*last);
    }
    require(client.output().size() <= 32, "what is to be written is short");
    client.output_taken();
  }
  return last;
}

}  // namespace
}  // namespace edsc::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace edsc::fuzz;
  if (size == 0) return 0;
  SocketcandClient client;
  client.start("vcan0", {});
  if (data[0] % 2 == 0) (void)hear(client, "< hi >< ok >< ok >");
  (void)hear(client, {reinterpret_cast<const char*>(data + 1), size - 1});
  if (client.state() == SocketcandClient::State::refused) {
    require(client.problem().size() <= 64, "a problem is short");
    return 0;
  }
  if (client.state() != SocketcandClient::State::open) return 0;
  const auto frame = hear(client, "< frame 123 1.5 AABB >");
  require(frame && frame->id == 0x123 && frame->data[1] == 0xBB, "the next message is understood");
  return 0;
}
