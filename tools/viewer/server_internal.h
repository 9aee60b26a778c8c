#pragma once
#include <boost/asio/generic/stream_protocol.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <functional>
#include <list>
#include <memory>
#include <vector>

#include "tools/viewer/access_internal.h"
#include "tools/viewer/shared_state_internal.h"

namespace ossa::viewer {

/// The connection of one browser. All are used on the one thread of the server.
class Connection {
 public:
  virtual ~Connection() = default;
  virtual void Close() = 0;
};

/// Accepts connections and answers them (Boost.Beast), all on the thread that runs context(),
/// without blocking on any of them. Of too many connections the oldest that has not become a stream
/// is closed.
class Server {
 public:
  using Socket = boost::asio::generic::stream_protocol::socket;

  Server(SharedState& shared, Access access);
  /// Throws InputError where the port is taken.
  void Listen(const boost::asio::ip::tcp::endpoint& at);
  /// 0 where it does not listen; sessions started by StartSession() are answered all the same.
  int port() const;
  boost::asio::io_context& context() { return context_; }
  /// Serves HTTP over a connected socket.
  void StartSession(Socket socket);
  /// Wakes connections that wait for an update. From any thread.
  void Notify();
  /// Calls `then` after the next Notify(), or after a second, on the server's thread.
  void WaitForUpdate(std::function<void()> then);

  SharedState& shared() { return shared_; }
  const Access& access() const { return access_; }
  /// Counts the connection among those that may be closed for new ones.
  void Register(const std::shared_ptr<Connection>& connection);
  void Forget(const Connection* connection);

 private:
  void Accept();
  void AcceptLater();
  void NotifyEverySecond();
  void RunWaiting();

  SharedState& shared_;
  const Access access_;
  std::list<std::weak_ptr<Connection>> connections_;  // oldest first
  boost::asio::io_context context_{1};                // ends before what its handlers use
  boost::asio::ip::tcp::acceptor acceptor_{context_};
  boost::asio::steady_timer second_{context_};
  boost::asio::steady_timer retry_{context_};
  std::vector<std::function<void()>> waiting_;  // of connections, which end before the context
};

}  // namespace ossa::viewer
