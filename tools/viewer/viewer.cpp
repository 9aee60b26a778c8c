#include "tools/viewer/viewer.h"

#include <ifaddrs.h>
#include <net/if.h>
#include <netdb.h>

#include <fstream>
#include <thread>
#include <utility>

#include "depth/base/error.h"
#include "tools/viewer/server_internal.h"
#include "tools/viewer/shared_state_internal.h"

namespace ossa::viewer {
namespace {

namespace ip = boost::asio::ip;

ip::address AddressOf(const ViewerOptions& options) {
  boost::system::error_code error;
  const ip::address address = ip::make_address(options.address, error);
  if (error) throw InputError(options.address + ": expected an IP address of this machine");
  if (!address.is_loopback() && options.token.empty()) {
    throw InputError(options.address + ": other machines reach it: expected a token");
  }
  return address;
}

std::string Url(const ip::address& address, int port, const std::string& token) {
  const std::string text = address.to_string();
  return "http://" + (address.is_v6() ? "[" + text + "]" : text) + ":" + std::to_string(port) +
         "/" + (token.empty() ? "" : "?token=" + token);
}

// Addresses of this machine in its networks.
std::vector<ip::address> AddressesInNetworks() {
  std::vector<ip::address> found;
  ifaddrs* first = nullptr;
  if (getifaddrs(&first) != 0) return found;
  for (const ifaddrs* one = first; one != nullptr; one = one->ifa_next) {
    if (one->ifa_addr == nullptr || one->ifa_addr->sa_family != AF_INET) continue;
    if ((one->ifa_flags & IFF_LOOPBACK) != 0 || (one->ifa_flags & IFF_UP) == 0) continue;
    char text[NI_MAXHOST];
    if (getnameinfo(one->ifa_addr, sizeof(sockaddr_in), text, sizeof(text), nullptr, 0,
                    NI_NUMERICHOST) == 0) {
      found.push_back(ip::make_address(text));
    }
  }
  freeifaddrs(first);
  return found;
}

}  // namespace

struct Viewer::Impl {
  explicit Impl(const ViewerOptions& options)
      : address(AddressOf(options)),
        shared(options),
        server(shared, {.loopback = address.is_loopback(), .token = options.token}) {
    server.Listen({address, static_cast<uint16_t>(options.port)});
    thread = std::thread([this] { Serve(); });
  }
  ~Impl() {
    server.context().stop();
    if (thread.joinable()) thread.join();
  }

  // A failure, such as a full disk, closes its own connection only.
  void Serve() {
    while (!server.context().stopped()) {
      try {
        server.context().run();
      } catch (const std::exception&) {
        continue;
      }
    }
  }

  const ip::address address;
  SharedState shared;
  Server server;
  std::thread thread;
};

Viewer::Viewer(const ViewerOptions& options) : impl_(std::make_unique<Impl>(options)) {}
Viewer::~Viewer() = default;

int Viewer::port() const { return impl_->server.port(); }

std::vector<std::string> Viewer::urls() const {
  std::vector<ip::address> addresses = {impl_->address};
  if (impl_->address.is_unspecified()) {
    addresses = AddressesInNetworks();
    addresses.insert(addresses.begin(), ip::make_address("127.0.0.1"));
  }
  std::vector<std::string> urls;
  for (const ip::address& address : addresses) {
    urls.push_back(Url(address, port(), impl_->shared.options.token));
  }
  return urls;
}

void Viewer::Show(DisplayFrame display) {
  impl_->shared.recorder.Take(display.depth);
  impl_->shared.store.Add(std::move(display));
  impl_->server.Notify();
}

void Viewer::Complete() {
  impl_->shared.store.Complete();
  impl_->server.Notify();
}

void Viewer::Clear() {
  impl_->shared.store.Clear();
  impl_->server.Notify();
}

std::optional<Settings> Viewer::TakeSettings() { return impl_->shared.TakeSettings(); }

void Viewer::Refuse(const Settings& still, const std::string& why) {
  impl_->shared.Refuse(still, why);
}

std::string RandomToken() {
  constexpr size_t kBytes = 16;  // 128 bits, by convention
  std::ifstream random("/dev/urandom", std::ios::binary);
  std::string token;
  for (size_t i = 0; i < kBytes; ++i) {
    const int byte = random.get();
    if (byte < 0) throw InputError("/dev/urandom: expected random bytes");
    token += "0123456789abcdef"[byte / 16];
    token += "0123456789abcdef"[byte % 16];
  }
  return token;
}

}  // namespace ossa::viewer
