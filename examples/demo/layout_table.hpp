/// A table of a device's PDO bit layouts.
#pragma once

#include <canopen/od/description.hpp>
#include <span>
#include <string_view>
#include <vector>

#include "pdo_description.hpp"

namespace demo {

void print_layouts(std::string_view device, std::span<const PdoDescription> pdos,
                   std::span<const canopen::EntryDescription> names);

}  // namespace demo
