/// Findings that the options file or comments of a file silence or allow.
#pragma once

#include "device/options/options.hpp"
#include "diagnostics/diagnostics.hpp"
#include "text/source_file.hpp"

namespace edsc {

/// Silences the rules of the member `silence`. An unknown rule is an error.
void silence_by_options(const Options& options, Diagnostics& diagnostics);

/// Registers the allowances of the member `allow`. An unknown rule is an error.
void allow_by_options(const Options& options, Diagnostics& diagnostics);

/// Registers the allowances in the comments of an EDS or DCF, and the outline that these and the options need.
void allow_by_comments(const SourceFile& source, const Options& options, Diagnostics& diagnostics);

}  // namespace edsc
