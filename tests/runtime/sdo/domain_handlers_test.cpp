#include <gtest/gtest.h>
#include <canopen/sdo/domain_handlers.hpp>

#include <string>
#include <tuple>
#include <vector>

#include "sdo_bench.hpp"

namespace {

using canopen::AbortCode;
namespace od = sample::od;

/// The server of a device whose application streams 2012h and 201Ah.
template <class... Handlers>
class StreamBench {
 public:
  using Set = canopen::DomainHandlerSet<Handlers...>;

  explicit StreamBench(Handlers... handlers) : handlers_{std::move(handlers)...} {}

  struct Hooks {
    StreamBench& bench;
    [[nodiscard]] canopen::EntryAccess<bench::WithBlock> entries() const { return bench.store.entries(); }
    [[nodiscard]] AbortCode before_read(std::uint16_t, std::uint8_t) const { return canopen::ok; }
    [[nodiscard]] AbortCode write(std::uint16_t index, std::uint8_t sub_index, canopen::entry::Word word,
                                  std::span<std::uint8_t> bytes) const {
      entries().write(word, bytes);
      written(index, sub_index);
      return canopen::ok;
    }
    void written(std::uint16_t, std::uint8_t) const { ++bench.written; }
    static canopen::AbortCode command(std::uint16_t, std::uint8_t, std::span<const std::uint8_t>) {
      return canopen::AbortCode::not_stored;
    }
    [[nodiscard]] bool streams_upload(std::uint16_t index, std::uint8_t sub_index) const {
      return Set::streams_upload(canopen::object_key(index, sub_index));
    }
    [[nodiscard]] bool streams_download(std::uint16_t index, std::uint8_t sub_index) const {
      return Set::streams_download(canopen::object_key(index, sub_index));
    }
    [[nodiscard]] canopen::Result<std::uint32_t> read_domain(std::uint16_t index, std::uint8_t sub_index,
                                                             std::uint32_t offset,
                                                             std::span<std::uint8_t> bytes) const {
      return Set::read(bench.handlers_, bench, canopen::object_key(index, sub_index), offset, bytes);
    }
    [[nodiscard]] AbortCode write_domain(std::uint16_t index, std::uint8_t sub_index, std::uint32_t offset,
                                         std::span<const std::uint8_t> bytes, bool last) const {
      return Set::write(bench.handlers_, bench, canopen::object_key(index, sub_index), offset, bytes, last);
    }
  };
  static_assert(canopen::DomainStreamHooks<Hooks, bench::WithBlock>);

  std::string ask(const std::string& request) {
    server.on_request(bench::bytes_of(request), Hooks{*this}, {});
    std::string text;
    while (server.has_reply()) {
      text += (text.empty() ? "" : " | ") + bench::text_of(server.reply());
      server.reply_sent(Hooks{*this}, {});
    }
    return text;
  }

  canopen::ObjectStore<bench::WithBlock> store;
  canopen::SdoServer<bench::WithBlock> server;
  int written = 0;

 private:
  std::tuple<Handlers...> handlers_;
};

/// A file of `size` bytes 0, 1, 2 ...
auto file(std::uint32_t size) {
  return [size](std::uint32_t offset, std::span<std::uint8_t> bytes) {
    std::uint32_t count = 0;
    for (; count < bytes.size() && offset + count < size; ++count)
      bytes[count] = static_cast<std::uint8_t>(offset + count);
    return count;
  };
}

auto reading(std::uint32_t size) { return StreamBench{canopen::on_domain_read<od::log_file>(file(size))}; }

TEST(DomainHandlers, GiveASegmentedUploadItsBytes) {
  auto device = reading(9);
  EXPECT_EQ(device.ask("40 1A 20 00 00 00 00 00"), "40 1A 20 00 00 00 00 00");  // the size is unknown
  EXPECT_EQ(device.ask("60 00 00 00 00 00 00 00"), "00 00 01 02 03 04 05 06");
  EXPECT_EQ(device.ask("70 00 00 00 00 00 00 00"), "1B 07 08 00 00 00 00 00");
}

TEST(DomainHandlers, EndAnUploadOfWholeSegmentsWithAnEmptyOne) {
  auto device = reading(7);
  device.ask("40 1A 20 00 00 00 00 00");
  EXPECT_EQ(device.ask("60 00 00 00 00 00 00 00"), "00 00 01 02 03 04 05 06");
  EXPECT_EQ(device.ask("70 00 00 00 00 00 00 00"), "1F 00 00 00 00 00 00 00");
}

TEST(DomainHandlers, GiveABlockUploadItsBytesAndThoseOfALostSegmentAgain) {
  auto device = reading(15);
  EXPECT_EQ(device.ask("A4 1A 20 00 7F FF 00 00"), "C4 1A 20 00 00 00 00 00");
  EXPECT_EQ(device.ask("A3 00 00 00 00 00 00 00"),
            "01 00 01 02 03 04 05 06 | 02 07 08 09 0A 0B 0C 0D | 83 0E 00 00 00 00 00 00");
  EXPECT_EQ(device.ask("A2 01 7F 00 00 00 00 00"), "01 07 08 09 0A 0B 0C 0D | 82 0E 00 00 00 00 00 00");
  EXPECT_EQ(device.ask("A2 02 7F 00 00 00 00 00"), "D9 92 9B 00 00 00 00 00");
}

TEST(DomainHandlers, MayRefuseAnUploadAtAnyByte) {
  StreamBench device{canopen::on_domain_read<od::log_file>(
      [](std::uint32_t offset, std::span<std::uint8_t> bytes) -> canopen::Result<std::uint32_t> {
        if (offset >= 14) return AbortCode::hardware;
        return static_cast<std::uint32_t>(bytes.size());
      })};
  device.ask("A4 1A 20 00 7F 00 00 00");
  EXPECT_EQ(device.ask("A3 00 00 00 00 00 00 00"),
            "01 00 00 00 00 00 00 00 | 02 00 00 00 00 00 00 00 | 80 1A 20 00 00 00 06 06");
}

struct Piece {
  std::uint32_t offset;
  std::vector<std::uint8_t> bytes;
  bool last;
  bool operator==(const Piece&) const = default;
};

auto recording(std::vector<Piece>& pieces) {
  return StreamBench{canopen::on_domain_write<od::parameter_file>(
      [&pieces](std::uint32_t offset, std::span<const std::uint8_t> bytes, bool last) {
        pieces.push_back({offset, {bytes.begin(), bytes.end()}, last});
      })};
}

TEST(DomainHandlers, TakeTheSegmentsOfADownload) {
  std::vector<Piece> pieces;
  auto device = recording(pieces);
  EXPECT_EQ(device.ask("21 12 20 00 09 00 00 00"), "60 12 20 00 00 00 00 00");
  EXPECT_EQ(device.ask("00 01 02 03 04 05 06 07"), "20 00 00 00 00 00 00 00");
  EXPECT_EQ(device.written, 0);
  EXPECT_EQ(device.ask("1B 08 09 00 00 00 00 00"), "30 00 00 00 00 00 00 00");
  EXPECT_EQ(pieces, (std::vector<Piece>{{0, {1, 2, 3, 4, 5, 6, 7}, false}, {7, {8, 9}, true}}));
  EXPECT_EQ(device.written, 1);
}

TEST(DomainHandlers, TakeAnExpeditedDownloadAsOnePiece) {
  std::vector<Piece> pieces;
  auto device = recording(pieces);
  EXPECT_EQ(device.ask("27 12 20 00 01 02 03 00"), "60 12 20 00 00 00 00 00");
  EXPECT_EQ(pieces, (std::vector<Piece>{{0, {1, 2, 3}, true}}));
}

TEST(DomainHandlers, TakeABlockDownloadWhoseLastPieceWaitsForTheCrc) {
  std::vector<Piece> pieces;
  auto device = recording(pieces);
  EXPECT_EQ(device.ask("C4 12 20 00 00 00 00 00"), "A4 12 20 00 7F 00 00 00");
  device.ask("01 31 32 33 34 35 36 37");
  EXPECT_EQ(device.ask("82 38 39 00 00 00 00 00"), "A2 02 7F 00 00 00 00 00");
  EXPECT_EQ(pieces.size(), 1u);
  EXPECT_EQ(device.ask("D5 C3 31 00 00 00 00 00"), "A1 00 00 00 00 00 00 00");
  EXPECT_EQ(pieces,
            (std::vector<Piece>{{0, {0x31, 0x32, 0x33, 0x34, 0x35, 0x36, 0x37}, false}, {7, {0x38, 0x39}, true}}));

  pieces.clear();
  device.ask("C4 12 20 00 00 00 00 00");
  device.ask("81 31 32 33 34 35 36 37");
  EXPECT_EQ(device.ask("C1 00 00 00 00 00 00 00"), "80 12 20 00 04 00 04 05");
  EXPECT_TRUE(pieces.empty());
}

TEST(DomainHandlers, HaveNoLastPieceWhereTheSizeLies) {
  std::vector<Piece> pieces;
  auto device = recording(pieces);
  device.ask("21 12 20 00 09 00 00 00");
  device.ask("00 01 02 03 04 05 06 07");
  EXPECT_EQ(device.ask("1D 08 00 00 00 00 00 00"), "80 12 20 00 10 00 07 06");
  device.ask("C2 12 20 00 08 00 00 00");
  device.ask("81 01 02 03 04 05 06 07");
  EXPECT_EQ(device.ask("C1 00 00 00 00 00 00 00"), "80 12 20 00 10 00 07 06");
  EXPECT_EQ(pieces.size(), 1u);
  EXPECT_EQ(device.written, 0);
}

TEST(DomainHandlers, MayRefuseAPieceAndKnowTheirNode) {
  StreamBench device{canopen::on_domain_write<od::parameter_file>(
      [](auto& bench, std::uint32_t offset, std::span<const std::uint8_t>, bool) {
        return bench.written == 0 && offset == 7 ? AbortCode::local_control : canopen::ok;
      })};
  device.ask("C0 12 20 00 00 00 00 00");
  EXPECT_EQ(device.ask("01 01 02 03 04 05 06 07"), "");
  EXPECT_EQ(device.ask("02 01 02 03 04 05 06 07"), "80 12 20 00 21 00 00 08");
}

TEST(DomainHandlers, LeaveOtherDomainsToTheirMemory) {
  auto device = reading(9);
  EXPECT_EQ(device.ask("40 12 20 00 00 00 00 00"), "80 12 20 00 24 00 00 08");
  EXPECT_EQ(device.ask("21 12 20 00 09 00 00 00"), "80 12 20 00 20 00 00 08");
  std::array<std::uint8_t, 5> memory{1, 2, 3, 4, 5};
  device.store.set<od::parameter_file>({memory.data(), 5, 5});
  EXPECT_EQ(device.ask("40 12 20 00 00 00 00 00"), "41 12 20 00 05 00 00 00");
  static_assert(!canopen::DomainHandlerSet<>::any);
}

}  // namespace
