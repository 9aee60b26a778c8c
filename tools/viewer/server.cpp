#include "tools/viewer/server_internal.h"

#include <boost/asio/post.hpp>
#include <chrono>
#include <string>
#include <utility>

#include "depth/base/error.h"
#include "tools/viewer/session_internal.h"

namespace ossa::viewer {

namespace asio = boost::asio;
using asio::ip::tcp;

namespace {

// Why the server cannot listen at an address, and what is expected instead.
InputError DescribeListenError(const tcp::endpoint& at, const boost::system::error_code& error) {
  const std::string address = at.address().to_string(), why = " (" + error.message() + ")";
  const std::string port = "port " + std::to_string(at.port()) + ": expected a ";
  if (error == asio::error::address_in_use) {
    return InputError(port + "free port on " + address + ", it is taken" + why);
  }
  if (error == asio::error::access_denied) {
    return InputError(port + "port that this user may open, 1024 or more" + why);
  }
  return InputError(address + ": expected an IP address of this machine" + why);
}

}  // namespace

Server::Server(SharedState& shared, Access access) : shared_(shared), access_(std::move(access)) {
  NotifyEverySecond();
}

void Server::Listen(const tcp::endpoint& at) {
  boost::system::error_code error;
  acceptor_.open(at.protocol(), error);
  if (!error) acceptor_.set_option(tcp::acceptor::reuse_address(true), error);
  if (!error) acceptor_.bind(at, error);
  if (!error) acceptor_.listen(asio::socket_base::max_listen_connections, error);
  if (error) throw DescribeListenError(at, error);
  Accept();
}

int Server::port() const {
  boost::system::error_code closed;
  return acceptor_.local_endpoint(closed).port();
}

void Server::Accept() {
  acceptor_.async_accept([this](const boost::system::error_code& error, tcp::socket socket) {
    if (error == asio::error::operation_aborted) return;
    if (error) return AcceptLater();
    boost::system::error_code ignored;
    socket.set_option(tcp::no_delay(true), ignored);
    StartSession(Socket(std::move(socket)));
    Accept();
  });
}

// Without free file descriptors new connections wait; accepting again at once would fail at once.
void Server::AcceptLater() {
  constexpr std::chrono::milliseconds kPause{100};  // by hand
  retry_.expires_after(kPause);
  retry_.async_wait([this](const boost::system::error_code& error) {
    if (!error) Accept();
  });
}

void Server::StartSession(Socket socket) { StartHttp(*this, std::move(socket)); }

void Server::Notify() {
  asio::post(context_, [this] { RunWaiting(); });
}

void Server::WaitForUpdate(std::function<void()> then) { waiting_.push_back(std::move(then)); }

void Server::RunWaiting() {
  std::vector<std::function<void()>> now;
  now.swap(waiting_);
  for (const auto& then : now) then();
}

void Server::NotifyEverySecond() {
  second_.expires_after(std::chrono::seconds(1));
  second_.async_wait([this](const boost::system::error_code& error) {
    if (error) return;
    RunWaiting();
    NotifyEverySecond();
  });
}

void Server::Register(const std::shared_ptr<Connection>& connection) {
  // Count; a browser opens six, and a descriptor each is taken of the usual 1024. By hand.
  constexpr size_t kMostConnections = 256;
  connections_.push_back(connection);
  if (connections_.size() <= kMostConnections) return;
  const std::shared_ptr<Connection> oldest = connections_.front().lock();
  connections_.pop_front();
  if (oldest) oldest->Close();
}

void Server::Forget(const Connection* connection) {
  connections_.remove_if([&](const std::weak_ptr<Connection>& one) {
    const std::shared_ptr<Connection> alive = one.lock();
    return !alive || alive.get() == connection;
  });
}

}  // namespace ossa::viewer
