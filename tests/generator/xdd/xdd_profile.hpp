/// Short XDD files, and the DataSheet that is read from them.
#pragma once

#include "xdd/read_xdd.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "text/source_file.hpp"

namespace edsc {

/// A short profile container: the device profile is on line 2, the network profile starts on line 3.
struct Profile {
  std::string objects;
  std::string process;
  std::string identity;
  std::string network = {};

  [[nodiscard]] std::string text() const {
    return "<ISO15745ProfileContainer xmlns:xsi='x'><ISO15745Profile><ProfileBody "
           "xsi:type='ProfileBody_Device_CANopen'>\n"
           "<DeviceIdentity>" +
           identity + "</DeviceIdentity><ApplicationProcess>" + process +
           "</ApplicationProcess>"
           "</ProfileBody></ISO15745Profile><ISO15745Profile>"
           "<ProfileBody xsi:type='ProfileBody_CommunicationNetwork_CANopen'>\n"
           "<ApplicationLayers><CANopenObjectList>\n" +
           objects + "</CANopenObjectList></ApplicationLayers>" + network +
           "</ProfileBody></ISO15745Profile></ISO15745ProfileContainer>\n";
  }
};

/// Line of the first of `Profile::objects`.
inline constexpr std::uint32_t first_line = 4;

struct ReadXdd {
  explicit ReadXdd(std::string text, std::string name = "test.xdd")
      : source(std::move(name), std::move(text)), sheet(read_xdd(source, diagnostics)) {}
  explicit ReadXdd(const Profile& profile, std::string name = "test.xdd") : ReadXdd(profile.text(), std::move(name)) {}

  [[nodiscard]] const ObjectDescription& object(std::size_t at = 0) const { return sheet.objects.at(at); }

  SourceFile source;
  Diagnostics diagnostics;
  DataSheet sheet;
};

/// A VAR that refers to the parameter `p`.
inline const std::string referring_object = "<CANopenObject index='2000' name='x' objectType='7' uniqueIDRef='p'/>";

inline std::string parameter(std::string_view inside, std::string_view attributes = "") {
  return "<parameterList><parameter uniqueID='p' " + std::string{attributes} + ">" + std::string{inside} +
         "</parameter></parameterList>";
}

}  // namespace edsc
