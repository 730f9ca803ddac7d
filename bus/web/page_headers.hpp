/// The headers of pages that edsc serves, and of its answers.
#pragma once

#include <string>
#include <string_view>
#include <utility>

namespace edsc {

inline constexpr std::pair<const char*, const char*> page_headers[] = {
    {"Cache-Control", "no-store"},
    {"Cross-Origin-Opener-Policy", "same-origin"},
    {"Cross-Origin-Resource-Policy", "same-origin"},
    {"Referrer-Policy", "no-referrer"},
    {"X-Content-Type-Options", "nosniff"},
    {"X-Frame-Options", "DENY"},
};

/// The content security policy of a page whose scripts and styles have this nonce.
[[nodiscard]] inline std::string page_policy(const std::string& nonce) {
  return "default-src 'none'; script-src 'nonce-" + nonce + "'; style-src 'nonce-" + nonce +
         "'; connect-src 'self'; img-src data:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
}

/// The page with the nonce in place of `{{{nonce}}}`.
[[nodiscard]] inline std::string with_nonce(std::string page, std::string_view nonce) {
  constexpr std::string_view placeholder = "{{{nonce}}}";
  for (std::size_t at = 0; (at = page.find(placeholder, at)) != std::string::npos;) {
    page.replace(at, placeholder.size(), nonce);
  }
  return page;
}

}  // namespace edsc
