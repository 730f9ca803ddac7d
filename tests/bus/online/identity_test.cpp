/// The identity of a device in its file, and the maximum number of bytes of an upload.
#include "online/identity.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "online/sdo_access.hpp"
#include "support/device_from_text.hpp"

namespace edsc {
namespace {

/// Objects 1000h and 1018h.
std::string file_with(std::string_view device_type, std::string_view vendor, std::string_view product,
                      std::string_view revision) {
  const auto number = [](std::string_view section, std::string_view value) {
    return var(section, section, "0x7", "ro", fmt::format("DefaultValue={}\n", value));
  };
  return number("1000", device_type) + group("1018", "Identity object", "0x9", 4) +
         var("1018sub0", "Count", "0x5", "const", "DefaultValue=3\n") + number("1018sub1", vendor) +
         number("1018sub2", product) + number("1018sub3", revision);
}

constexpr std::string_view device_info = "[DeviceInfo]\nVendorNumber=0x71\nProductNumber=0x72\nRevisionNumber=0x73\n";

TEST(IdentityOf, IsThatOfTheObjects) {
  const DeviceFromText text(std::string{device_info} + file_with("0x20192", "0x93", "0x5", "0x10002"));
  const Identity identity = identity_of(text.device);
  EXPECT_EQ(identity.device_type, 0x20192U);
  EXPECT_EQ(identity.vendor_id, 0x93U);
  EXPECT_EQ(identity.product_code, 5U);
  EXPECT_EQ(identity.revision_number, 0x10002U);
  EXPECT_EQ(identity.serial_number, std::nullopt);
}

TEST(IdentityOf, IsThatOfDeviceInfoWhereTheObjectsAreZero) {
  const DeviceFromText text(std::string{device_info} + file_with("0", "0", "0", "0"));
  const Identity identity = identity_of(text.device);
  EXPECT_EQ(identity.device_type, std::nullopt);
  EXPECT_EQ(identity.vendor_id, 0x71U);
  EXPECT_EQ(identity.product_code, 0x72U);
  EXPECT_EQ(identity.revision_number, 0x73U);
}

TEST(IdentityOf, HasNoNumberThatFollowsTheNodeId) {
  const DeviceFromText text(file_with("$NODEID+0x192", "0x93", "0x5", "0x10002"));
  EXPECT_EQ(identity_of(text.device).device_type, std::nullopt);
}

TEST(IdentityOf, HasTheSerialNumberOfADcf) {
  const DeviceFromText text(
      "[DeviceComissioning]\nNodeID=5\nLSS_SerialNumber=0x1234\n" + file_with("0x192", "1", "2", "3"), {}, {},
      "test.dcf");
  EXPECT_EQ(identity_of(text.device).serial_number, 0x1234U);
}

TEST(CompareIdentity, ComparesEachNumber) {
  const Identity device{0x192, 0x93, 5, 0x10002, 9};
  EXPECT_EQ(compare_identity(device, device), IdentityMatch::same);
  for (const auto number :
       {&Identity::device_type, &Identity::vendor_id, &Identity::product_code, &Identity::serial_number}) {
    Identity other = device;
    other.*number = 77;
    EXPECT_EQ(compare_identity(device, other), IdentityMatch::other);
    EXPECT_FALSE(identity_differences(device, other).empty());
    other.*number = {};
    EXPECT_EQ(compare_identity(device, other), IdentityMatch::same);
    EXPECT_EQ(not_compared(device, other).size(), 1U);
  }
}

// ---- uploads ----

const std::vector<std::uint8_t> four_bytes{1, 2, 3, 4};

TEST(UploadBuffer, TakesAsManyBytesAsItMay) {
  UploadBuffer buffer{8};
  EXPECT_EQ(buffer.append(four_bytes), canopen::ok);
  EXPECT_EQ(buffer.append(four_bytes), canopen::ok);
  EXPECT_EQ(buffer.take(), (std::vector<std::uint8_t>{1, 2, 3, 4, 1, 2, 3, 4}));
}

TEST(UploadBuffer, RejectsOneByteMore) {
  UploadBuffer buffer{7};
  EXPECT_EQ(buffer.append(four_bytes), canopen::ok);
  EXPECT_EQ(buffer.append(four_bytes), canopen::AbortCode::out_of_memory);
  EXPECT_EQ(buffer.take(), four_bytes);
}

TEST(SdoSettings, BoundAnUploadTo16Mebibytes) { EXPECT_EQ(SdoSettings{}.max_bytes, 16U << 20U); }

}  // namespace
}  // namespace edsc
