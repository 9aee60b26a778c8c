#include "tools/stream/target.h"

#include <charconv>
#include <cmath>
#include <optional>
#include <regex>

#include "depth/base/error.h"

namespace ossa::stream {
namespace {

// Constants: defaults of the two protocols.

constexpr int kVmcPort = 39539;
constexpr int kVrchatPort = 9000;

template <typename Number>
std::optional<Number> NumberIn(const std::string& text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

[[noreturn]] void Refuse(const std::string& url, const std::string& expected) {
  throw InputError("--send " + url + ": expected " + expected);
}

Protocol ParseProtocol(const std::string& name) {
  if (name == "vmc") return Protocol::kVmc;
  return name == "vrchat" ? Protocol::kVrchat : Protocol::kJsonl;
}

int ParsePort(const Target& target, const std::string& text) {
  if (text.empty()) {
    if (target.protocol == Protocol::kVmc) return kVmcPort;
    if (target.protocol == Protocol::kVrchat) return kVrchatPort;
  }
  const auto port = NumberIn<int>(text);
  if (!port || *port < 1 || *port > kMostPort) Refuse(target.url, "a port from 1 to 65535");
  return *port;
}

double ParseScale(const Target& target, const std::string& text) {
  if (text.empty()) return 1.0;
  if (target.protocol != Protocol::kVrchat) Refuse(target.url, "no scale but for vrchat://");
  const auto scale = NumberIn<double>(text);
  if (!scale || !std::isfinite(*scale) || *scale <= 0) Refuse(target.url, "a scale above 0");
  return *scale;
}

bool IsSeenOnly(const Target& target, const std::string& text) {
  if (text.empty()) return false;
  if (target.protocol != Protocol::kVmc) Refuse(target.url, "no bones but for vmc://");
  if (text != "all" && text != "seen") Refuse(target.url, "bones=all or bones=seen");
  return text == "seen";
}

}  // namespace

Target ParseTarget(const std::string& url) {
  static const std::regex form(
      R"((vmc|vrchat|udp)://(\[[0-9A-Fa-f:.%]+\]|[^\[\]:/?#\s]+)(?::([^?/#]*))?/?(?:\?(?:scale=(.+)|bones=(.+)))?)");
  std::smatch part;
  if (!std::regex_match(url, part, form)) {
    Refuse(url, "vmc://HOST:PORT, vrchat://HOST:PORT or udp://HOST:PORT");
  }
  Target target;
  target.url = url;
  target.protocol = ParseProtocol(part[1]);
  target.host = part[2];
  if (target.host.front() == '[') target.host = target.host.substr(1, target.host.size() - 2);
  target.port = ParsePort(target, part[3]);
  target.scale = ParseScale(target, part[4]);
  target.seen_only = IsSeenOnly(target, part[5]);
  return target;
}

}  // namespace ossa::stream
