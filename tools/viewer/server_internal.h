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
#include "tools/viewer/desk_internal.h"

namespace ossa::viewer {

/// One browser's line to us. All of them live on the server's one thread.
class Connection {
 public:
  virtual ~Connection() = default;
  virtual void Close() = 0;
};

/// Accepts connections and answers them (Boost.Beast), all on the thread that runs context().
/// What is slow waits for nobody and nobody for it; of too many connections the oldest that has not
/// become a stream is closed.
class Server {
 public:
  using Socket = boost::asio::generic::stream_protocol::socket;

  Server(Desk& desk, Access access);
  /// Throws InputError where the port is taken.
  void Listen(const boost::asio::ip::tcp::endpoint& at);
  /// 0 where it does not listen: what was adopted may be answered all the same.
  int port() const;
  boost::asio::io_context& context() { return context_; }
  /// Speaks HTTP over a socket that is connected.
  void Adopt(Socket socket);
  /// From any thread: something is new.
  void Ring();
  /// Runs once something is new, or a second has passed. On the server's thread.
  void WaitForBell(std::function<void()> then);

  Desk& desk() { return desk_; }
  const Access& access() const { return access_; }
  /// Counts the connection among those that may be closed for new ones.
  void Register(const std::shared_ptr<Connection>& connection);
  void Forget(const Connection* connection);

 private:
  void Accept();
  void AcceptLater();
  void ToldOrSecond();
  void CallWaiting();

  Desk& desk_;
  const Access access_;
  std::list<std::weak_ptr<Connection>> connections_;  // oldest first
  boost::asio::io_context context_{1};                // ends before what its handlers use
  boost::asio::ip::tcp::acceptor acceptor_{context_};
  boost::asio::steady_timer second_{context_};
  boost::asio::steady_timer retry_{context_};
  std::vector<std::function<void()>> waiting_;  // of connections, which end before the context
};

}  // namespace ossa::viewer
