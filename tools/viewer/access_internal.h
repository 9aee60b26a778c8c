#pragma once
#include <string>
#include <string_view>

namespace ossa::viewer {

/// Access control. The HTTP library parses the request.
struct Access {
  bool loopback = true;  // served to this machine only
  std::string token;     // empty: none is needed

  /// Pages of other hosts can make a browser send requests under their own host name (DNS
  /// rebinding): on loopback only names of this machine are accepted, otherwise also any IP
  /// address.
  bool AllowsHost(std::string_view host) const;
  /// By `?token=` of the target or by the cookie set in the answer to it; `port`: of the server.
  bool AllowsToken(std::string_view target, std::string_view cookies, int port) const;
  /// Pages of another origin may not open a WebSocket: the Origin must be this Host.
  static bool AllowsOrigin(std::string_view origin, std::string_view host);
};

/// Pages of this machine, such as one under development, may read events; others may not.
bool IsPageOfThisMachine(std::string_view origin);

/// The name of the cookie with the token. Browsers share cookies between all ports of a host: two
/// viewers on a machine must not overwrite each other's.
std::string TokenCookie(int port);

}  // namespace ossa::viewer
