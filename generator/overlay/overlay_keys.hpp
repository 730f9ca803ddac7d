/// The keys of [Overlay], and the keys that an overlay reserves in other sections.
#pragma once

#include <string_view>

#include "eds/sections/keys.hpp"
#include "overlay/overlay_file.hpp"

namespace edsc {

inline constexpr std::string_view overlay_section = "Overlay";

inline constexpr KeyRow<OverlayHeader> overlay_keys[] = {
    {{"Version", ValueKind::number}, &OverlayHeader::version},
    {{"Base"}, &OverlayHeader::base},
    {{"VendorNumber", ValueKind::number}, &OverlayHeader::vendor_number},
    {{"ProductNumber", ValueKind::number}, &OverlayHeader::product_number},
    {{"RevisionNumber", ValueKind::number}, &OverlayHeader::revision_number},
    {{"Encoding"}, &OverlayHeader::encoding},
    {{"SubIndices"}, &OverlayHeader::sub_indices},
    {{"AccessTypes"}, &OverlayHeader::access_types},
};

/// `Remove=1`: the section, or the object with all its sections, is removed.
inline constexpr std::string_view remove_key = "Remove";
/// `Rename=2022subA`: the new name of the section.
inline constexpr std::string_view rename_key = "Rename";
/// `Count=32`: the number of values that a range changes.
inline constexpr std::string_view count_key = "Count";

inline constexpr std::string_view arrow = "=>";

}  // namespace edsc
