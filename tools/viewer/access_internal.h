#pragma once
#include <string>
#include <string_view>

namespace ossa::viewer {

/// Who may ask. What a request says of itself is taken apart by the HTTP library.
struct Access {
  bool loopback = true;  // served to this machine alone
  std::string token;     // empty: none is needed

  /// Pages elsewhere can make a browser ask under a name of theirs (DNS rebinding): on loopback
  /// this machine's names are answered, for other machines any plain IP address, too.
  bool AllowsHost(std::string_view host) const;
  /// By `?token=` of the target or by the cookie that it was answered with; `port`: of the server.
  bool AllowsToken(std::string_view target, std::string_view cookies, int port) const;
  /// A page of another place may open no WebSocket here: its Origin must be this Host.
  static bool AllowsOrigin(std::string_view origin, std::string_view host);
};

/// A page of this machine, such as one under development, may read events; one from elsewhere may
/// not.
bool IsPageOfThisMachine(std::string_view origin);

/// The name of the token's cookie. Browsers keep one store of cookies for all ports of a host: of
/// two viewers on a machine neither must overwrite the other's.
std::string TokenCookie(int port);

}  // namespace ossa::viewer
