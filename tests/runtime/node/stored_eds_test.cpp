/// 1021h and 1022h of devices that store their EDS: no code of the application binds it.
#include <gtest/gtest.h>

#include <compressed_eds/device.hpp>
#include <fstream>
#include <iterator>
#include <stored_eds/device.hpp>
#include <string>

#include "support/bench.hpp"

namespace {

std::string data_sheet() {
  std::ifstream file{EDSC_SOURCE_DIR "/tests/fixtures/stored_eds.eds", std::ios::binary};
  return {std::istreambuf_iterator<char>{file}, {}};
}

template <class Device>
std::string kept() {
  return {Device::stored_eds.begin(), Device::stored_eds.end()};
}

/// The four bytes of a size, as in a request or answer.
std::string size_text(std::size_t size) {
  canopen::Frame frame{};
  frame.size = 4;
  for (std::size_t i = 0; i < 4; ++i) frame.data.at(i) = static_cast<std::uint8_t>(size >> (8 * i));
  return bench::text(frame).substr(3);
}

template <class Device>
std::string segmented_upload(bench::Bench<Device>& device, std::size_t size) {
  EXPECT_EQ(device.ask("605 40 21 10 00 00 00 00 00"), "585 41 21 10 00" + size_text(size));
  std::string bytes;
  bool last = false;
  for (bool toggle = false; !last && bytes.size() <= size; toggle = !toggle) {
    const canopen::Frame segment =
        bench::frame(device.ask(toggle ? "605 70 00 00 00 00 00 00 00" : "605 60 00 00 00 00 00 00 00"));
    EXPECT_EQ(segment.data[0] & 0xF0, toggle ? 0x10 : 0x00);
    last = (segment.data[0] & 1) != 0;
    bytes.append(segment.data.begin() + 1, segment.data.end() - (segment.data[0] >> 1 & 7));
  }
  return bytes;
}

template <class Device>
std::string block_upload(bench::Bench<Device>& device, std::size_t size) {
  EXPECT_EQ(device.ask("605 A4 21 10 00 7F 00 00 00"), "585 C6 21 10 00" + size_text(size));
  std::string bytes;
  std::string request = "605 A3 00 00 00 00 00 00 00";
  for (bool last = false; !last && bytes.size() <= size;) {
    device.node.on_frame(bench::frame(request), device.now);
    std::uint8_t count = 0;
    for (; !device.bus.sent.empty(); device.bus.sent.pop_front()) {
      const canopen::Frame& segment = device.bus.sent.front();
      EXPECT_EQ(segment.data[0] & 0x7F, ++count);
      last = (segment.data[0] & 0x80) != 0;
      bytes.append(segment.data.begin() + 1, segment.data.end());
    }
    canopen::Frame answer = bench::frame("605 A2 00 7F 00 00 00 00 00");
    answer.data[1] = count;
    request = bench::text(answer);
  }
  std::uint16_t crc = 0;
  const canopen::Frame end = bench::frame(device.ask(request));
  EXPECT_EQ(end.data[0] & 0xE3, 0xC1);
  bytes.resize(bytes.size() - (end.data[0] >> 2 & 7));
  for (const char byte : bytes) crc = canopen::crc16_ccitt(crc, static_cast<std::uint8_t>(byte));
  EXPECT_EQ(end.data[1] | end.data[2] << 8, crc);
  EXPECT_EQ(device.ask("605 A1 00 00 00 00 00 00 00"), "");
  return bytes;
}

TEST(StoredEds, IsTheTextByteForByte) { EXPECT_EQ(kept<stored_eds::Device>(), data_sheet()); }

TEST(StoredEds, IsReadInSegments) {
  bench::Bench<stored_eds::Device> device;
  EXPECT_EQ(segmented_upload(device, data_sheet().size()), data_sheet());
}

TEST(StoredEds, IsReadInBlocks) {
  bench::Bench<stored_eds::Device> device;
  EXPECT_EQ(block_upload(device, data_sheet().size()), data_sheet());
}

TEST(StoredEds, StaysOverResets) {
  bench::Bench<stored_eds::Device> device;
  device.ask(bench::reset_node);
  device.ask(bench::reset_communication);
  EXPECT_EQ(segmented_upload(device, data_sheet().size()), data_sheet());
}

TEST(StoredEds, IsNotWritten) {
  bench::Bench<stored_eds::Device> device;
  EXPECT_EQ(device.ask("605 21 21 10 00 04 00 00 00"), "585 80 21 10 00 02 00 01 06");
}

TEST(StoredEds, TellsThatItIsText) {
  bench::Bench<stored_eds::Device> device;
  EXPECT_EQ(device.ask("605 40 22 10 00 00 00 00 00"), "585 4F 22 10 00 00 00 00 00");
}

TEST(CompressedEds, IsAGzipFileThatIsSmaller) {
  const std::string file = kept<compressed_eds::Device>();
  EXPECT_EQ(file.substr(0, 4), "\x1F\x8B\x08" + std::string(1, '\0'));
  EXPECT_LT(file.size(), data_sheet().size() / 2);
}

TEST(CompressedEds, IsReadInSegmentsAndInBlocks) {
  bench::Bench<compressed_eds::Device> device;
  const std::string file = kept<compressed_eds::Device>();
  EXPECT_EQ(segmented_upload(device, file.size()), file);
  EXPECT_EQ(block_upload(device, file.size()), file);
}

TEST(CompressedEds, TellsThatItsFormatIsTheManufacturers) {
  bench::Bench<compressed_eds::Device> device;
  EXPECT_EQ(device.ask("605 40 22 10 00 00 00 00 00"), "585 4F 22 10 00 80 00 00 00");
}

}  // namespace
