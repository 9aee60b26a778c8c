#include <arpa/inet.h>

#include "tools/viewer/access_internal.h"
#include "tools/viewer/answer_internal.h"

namespace ossa::viewer {
namespace {

// Without port and brackets.
std::string NameOf(std::string_view host) {
  const size_t colon = host.rfind(':');
  if (colon != std::string_view::npos && host.find(']', colon) == std::string_view::npos) {
    host = host.substr(0, colon);
  }
  if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
  return std::string(host);
}

bool IsAddress(const std::string& name) {
  in6_addr address{};
  return inet_pton(AF_INET, name.c_str(), &address) == 1 ||
         inet_pton(AF_INET6, name.c_str(), &address) == 1;
}

// Constant time for a given length: the time must not reveal how much of a token is right.
bool AreSame(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  int difference = 0;
  for (size_t i = 0; i < a.size(); ++i) difference |= a[i] ^ b[i];
  return difference == 0;
}

std::string_view CookieToken(std::string_view cookies, const std::string& name) {
  const std::string begin = name + "=";
  const size_t at = cookies.find(begin);
  if (at == std::string_view::npos) return {};
  const std::string_view value = cookies.substr(at + begin.size());
  return value.substr(0, value.find(';'));
}

}  // namespace

bool Access::AllowsHost(std::string_view host) const {
  if (host.empty()) return true;  // no browser
  const std::string name = NameOf(host);
  if (name == "127.0.0.1" || name == "localhost" || name == "::1") return true;
  return !loopback && IsAddress(name);
}

bool Access::AllowsToken(std::string_view target, std::string_view cookies, int port) const {
  return token.empty() || AreSame(QueryValue(target, "token"), token) ||
         AreSame(CookieToken(cookies, TokenCookie(port)), token);
}

bool Access::AllowsOrigin(std::string_view origin, std::string_view host) {
  return origin.empty() || origin == "http://" + std::string(host);
}

std::string TokenCookie(int port) { return "ossa_token_" + std::to_string(port); }

bool IsPageOfThisMachine(std::string_view origin) {
  for (const std::string_view host : {"http://localhost", "http://127.0.0.1"}) {
    if (!origin.starts_with(host)) continue;
    const std::string_view rest = origin.substr(host.size());
    if (rest.empty() || rest.front() == ':') return true;
  }
  return false;
}

}  // namespace ossa::viewer
