/// Arbitrary requests, at any time, on a bus with or without room: an SDO server stays inside its memory, answers each
/// request with a bounded number of frames, and passes on the bytes of a streamed DOMAIN in order.
///
/// An input is a sequence of steps of nine bytes: a control byte and a request. Bit 7 of the control byte takes the
/// index from a table, as random ones rarely exist; bits 4..6 select an additional action; bits 0..3 are the number of
/// answers that the bus accepts.
#include <canopen/od/object_store.hpp>
#include <canopen/sdo/sdo_server.hpp>
#include <sample/device.hpp>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

namespace {

namespace od = sample::od;
using canopen::AbortCode;

void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %s\n", what);
  std::abort();
}

struct Device : sample::Device {
  static constexpr canopen::DeviceOptions options{.sdo_block_transfer = true, .sdo_timeout = 100};
};

constexpr std::uint16_t indices[] = {0x1000, 0x1008, 0x1017, 0x2001, 0x2007, 0x200A, 0x200C,
                                     0x200D, 0x2012, 0x2012, 0x201A, 0x201A, 0x2013, 0x2014};

class Application {
 public:
  Application() {
    store.reset_application(canopen::NodeId{5});
    store.reset_communication(canopen::NodeId{5});
    bind(20);
  }

  /// A separate memory each time, so that writing outside it is detected.
  void bind(std::size_t size) {
    memory_.emplace_back(size);
    std::vector<std::uint8_t>& memory = memory_.back();
    const auto count = static_cast<std::uint32_t>(size);
    store.set<od::parameter_file>({memory.data(), count, count});
  }

  struct Hooks {
    Application& application;
    std::uint32_t& expected;  ///< offset of the next piece of this server's download
    [[nodiscard]] auto entries() const { return application.store.entries(); }
    [[nodiscard]] AbortCode before_read(std::uint16_t, std::uint8_t) const { return application.answer; }
    [[nodiscard]] AbortCode write(std::uint16_t, std::uint8_t, canopen::entry::Word word,
                                  std::span<std::uint8_t> bytes) const {
      if (application.answer == canopen::ok) entries().write(word, bytes);
      return application.answer;
    }
    void written(std::uint16_t, std::uint8_t) const {}
    static canopen::AbortCode command(std::uint16_t, std::uint8_t, std::span<const std::uint8_t>) {
      return canopen::AbortCode::not_stored;
    }
    [[nodiscard]] bool streams_upload(std::uint16_t index, std::uint8_t) const { return index == 0x201A; }
    [[nodiscard]] bool streams_download(std::uint16_t index, std::uint8_t) const {
      return index == 0x2012 && application.streams;
    }
    [[nodiscard]] canopen::Result<std::uint32_t> read_domain(std::uint16_t, std::uint8_t, std::uint32_t offset,
                                                             std::span<std::uint8_t> bytes) const {
      constexpr std::uint32_t length = 2000;
      require(offset <= length, "an upload asks for what there is");
      const auto count = std::min(static_cast<std::uint32_t>(bytes.size()), length - offset);
      std::memset(bytes.data(), 0x5A, count);
      return count;
    }
    [[nodiscard]] AbortCode write_domain(std::uint16_t, std::uint8_t, std::uint32_t offset,
                                         std::span<const std::uint8_t> bytes, bool last) const {
      require(offset == 0 || offset == expected, "a download comes in order");
      expected = last ? 0 : offset + static_cast<std::uint32_t>(bytes.size());
      return application.answer;
    }
  };

  canopen::ObjectStore<Device> store;
  AbortCode answer = canopen::ok;
  bool streams = false;

 private:
  std::vector<std::vector<std::uint8_t>> memory_;
};

void act(Application& application, canopen::SdoServer<Device>& server, unsigned what, std::uint8_t number,
         canopen::TimePoint& now) {
  switch (what) {
    case 1: now = now + canopen::Duration{number * 1000u}; return server.on_time(now);
    case 2: application.bind(number); return server.domain_rebound(0x2012, 0);
    case 3: return server.reset();
    case 4: application.answer = AbortCode::device_state; return;
    case 5:  // the application starts or stops streaming a DOMAIN, but only between two transfers
      server.domain_rebound(0x2012, 0);
      application.streams = !application.streams;
      return;
    default: application.answer = canopen::ok;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::size_t step = 9;
  Application application;
  std::array<canopen::SdoServer<Device>, 2> servers;
  std::array<std::uint32_t, 2> expected{};
  canopen::TimePoint now{};
  for (; size >= step; data += step, size -= step) {
    const std::uint8_t control = data[0];
    canopen::sdo::Data request;
    std::memcpy(request.data(), data + 1, request.size());
    if ((control & 0x80) != 0) {
      canopen::sdo::put_multiplexer(request, indices[request[1] % std::size(indices)], request[3]);
    }
    const std::size_t number = (control >> 3) & 1;
    canopen::SdoServer<Device>& server = servers[number];
    const Application::Hooks hooks{application, expected[number]};
    act(application, server, (control >> 4) & 7, request[7], now);
    server.on_request(request, hooks, now);
    const unsigned room = (control & 7) == 7 ? 1000 : control & 7;
    unsigned sent = 0;
    for (; sent < room && server.has_reply(); ++sent) server.reply_sent(hooks, now);
    require(sent <= 128, "a request has at most the answers of a sub-block");
    require(application.store.get<od::visible_string_value>().size <= 16, "a string fits its storage");
    const canopen::Domain domain = application.store.get<od::parameter_file>();
    require(domain.size <= domain.capacity, "a DOMAIN fits its memory");
  }
  return 0;
}
