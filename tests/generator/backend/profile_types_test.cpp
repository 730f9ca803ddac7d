/// The headers of the runtime with the types of CiA 402 are those of the profile's data, and devices use them.
#include "backend/cpp/profile_types.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>

#include "backend/cpp/cpp_view.hpp"
#include "backend/cpp/typed_values.hpp"
#include "support/device_from_text.hpp"
#include "support/read_options.hpp"

namespace edsc {
namespace {

/// Compares a header with the generated text. If it differs, writes the text into the working directory.
void expect_current(std::string_view name, const std::string& text) {
  const std::string path = EDSC_SOURCE_DIR "/runtime/include/canopen/profile/" + std::string{name};
  std::ifstream file{path, std::ios::binary};
  const std::string present{std::istreambuf_iterator<char>{file}, {}};
  if (present == text) return;
  std::ofstream{std::string{name}, std::ios::binary} << text;
  ADD_FAILURE() << path << " is not what the profile states; copy " << name << " from the working directory";
}

TEST(ProfileTypes, HeadersOfTheRuntimeAreCurrent) {
  expect_current(cia402_types.types_file, cia402_types_header());
  expect_current(cia402_types.text_file, cia402_text_header());
}

/// The C++ type of 6041h, or of another entry.
std::string type_in(const std::string& objects, std::uint16_t index, const char* options = "{}") {
  const ReadOptions read{options};
  const DeviceFromText device{var("1000", "Device type", "7", "ro", "DefaultValue=0x00020192\n") + objects,
                              read.options};
  const TypedValues typed{device.named(), device.options};
  const TypedValue* const value = typed.find(device.entry(index));
  if (value == nullptr) return "";
  for (const nlohmann::ordered_json& row : typed.definitions()["rows"]) {
    const nlohmann::ordered_json& alias = row["alias"];
    if (!alias.is_null() && "meaning::" + alias["identifier"].get<std::string>() == value->type) return alias["type"];
  }
  return value->type;
}

TEST(ProfileTypes, AreThoseOfDevicesWithTheSameNames) {
  const std::string status = var("6041", "Drive status", "6", "ro");
  EXPECT_EQ(type_in(status, 0x6041), "canopen::cia402::Statusword");
  EXPECT_EQ(type_in(var("6841", "Status of axis 2", "6", "ro"), 0x6841), "canopen::cia402::Statusword");
  EXPECT_EQ(type_in(var("6061", "Mode", "2", "ro") + var("6060", "Mode", "2", "rw"), 0x6061),
            "canopen::cia402::ModesOfOperation");
  EXPECT_EQ(type_in(status, 0x6041, R"({ "meaning": { "6041h": { "place": "4.3.2" } } })"),
            "canopen::cia402::Statusword")
      << "a place is not another type";
}

TEST(ProfileTypes, AreNotThoseOfDevicesWithOtherNames) {
  const std::string status = var("6041", "Status", "6", "ro"), mode = var("6060", "Mode", "2", "rw");
  EXPECT_EQ(type_in(status, 0x6041, R"({ "meaning": { "6041h": { "bits": { "0": "ready" } } } })"), "meaning::status");
  EXPECT_EQ(type_in(mode, 0x6060, R"({ "meaning": { "6060h": { "values": { "1": "profile_position" } } } })"),
            "meaning::mode");
  EXPECT_EQ(type_in(var("6041", "Status", "7", "ro"), 0x6041), "meaning::status") << "32 bits";
}

}  // namespace
}  // namespace edsc
