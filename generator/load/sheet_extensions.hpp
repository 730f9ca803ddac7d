/// The names of device files.
#pragma once

#include <string_view>

namespace edsc {

inline constexpr std::string_view sheet_extensions[] = {".eds", ".dcf", ".xdd", ".xdc", ".overlay"};
/// Those that `edsc format` can write in place.
inline constexpr std::string_view canonical_extensions[] = {".eds", ".dcf"};

}  // namespace edsc
