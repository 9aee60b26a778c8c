#pragma once
#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <cstring>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

namespace ossa::viewer {

/// A raw HTTP client of the viewer, which may send anything.
class Client {
 public:
  explicit Client(int port) : socket_(socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const timeval patience{10, 0};
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof(patience));
    if (connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof(address)) != 0) {
      throw std::runtime_error("nobody listens at the port");
    }
  }
  Client(const Client&) = delete;
  ~Client() { close(socket_); }
  void Say(const std::string& text) const { send(socket_, text.data(), text.size(), MSG_NOSIGNAL); }
  /// All bytes until the other side closes.
  std::string Rest() const {
    std::string all;
    char piece[65536];
    for (;;) {
      const ssize_t size = recv(socket_, piece, sizeof(piece), 0);
      if (size <= 0) return all;
      all.append(piece, static_cast<size_t>(size));
    }
  }
  /// The first line of the answer; empty without one.
  std::string Answer() const {
    std::string text(4096, '\0');
    const ssize_t size = recv(socket_, text.data(), text.size(), 0);
    text.resize(size > 0 ? static_cast<size_t>(size) : 0);
    return text.substr(0, text.find('\r'));
  }

 private:
  int socket_;
};

inline std::string AnswerTo(int port, const std::string& request) {
  const Client client(port);
  client.Say(request + "\r\n\r\n");
  return client.Answer();
}

inline std::string Get(int port, const std::string& target) {
  const Client client(port);
  client.Say("GET " + target + " HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n");
  const std::string all = client.Rest();
  const size_t head = all.find("\r\n\r\n");
  return head == std::string::npos ? all : all.substr(head + 4);
}

/// The page's side of the WebSocket, by an independent client (Boost.Beast).
class PageClient {
 public:
  explicit PageClient(int port) : socket_(context_) {
    using boost::asio::ip::tcp;
    socket_.next_layer().connect(
        {boost::asio::ip::make_address("127.0.0.1"), static_cast<uint16_t>(port)});
    socket_.handshake("localhost:" + std::to_string(port), "/socket");
    socket_.read_message_max(0);
  }
  void Say(const std::string& text) { socket_.write(boost::asio::buffer(text)); }
  std::string Hear() {
    boost::beast::flat_buffer buffer;
    socket_.read(buffer);
    return boost::beast::buffers_to_string(buffer.data());
  }
  std::string Ask(const std::string& text) {
    Say(text);
    return Hear();
  }
  bool heard_binary() const { return socket_.got_binary(); }

 private:
  boost::asio::io_context context_;
  boost::beast::websocket::stream<boost::asio::ip::tcp::socket> socket_;
};

/// The header of a binary message.
inline nlohmann::json HeaderOf(const std::string& message) {
  uint32_t length = 0;
  std::memcpy(&length, message.data(), sizeof(length));
  return nlohmann::json::parse(message.substr(4, length));
}

/// What follows it: the pictures.
inline std::string PicturesOf(const std::string& message) {
  uint32_t length = 0;
  std::memcpy(&length, message.data(), sizeof(length));
  return message.substr(4 + length);
}

}  // namespace ossa::viewer
