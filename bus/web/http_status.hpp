/// The status codes of HTTP (RFC 9110, 15) that the servers of edsc answer with.
#pragma once

namespace edsc::http_status {

inline constexpr int ok = 200, bad_request = 400, forbidden = 403, not_found = 404, method_not_allowed = 405,
                     length_required = 411, too_large = 413, wrong_type = 415, no_range = 416, misdirected = 421;

}  // namespace edsc::http_status
