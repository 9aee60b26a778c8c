#pragma once

namespace ossa::test {

/// True under AddressSanitizer, which delays the freeing of memory and takes more of it.
#if defined(__SANITIZE_ADDRESS__)
inline constexpr bool kSanitized = true;
#elif defined(__has_feature)
inline constexpr bool kSanitized = __has_feature(address_sanitizer);
#else
inline constexpr bool kSanitized = false;
#endif

}  // namespace ossa::test
