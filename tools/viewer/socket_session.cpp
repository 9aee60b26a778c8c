#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <nlohmann/json.hpp>
#include <utility>

#include "depth/base/error.h"
#include "tools/viewer/message_internal.h"
#include "tools/viewer/session_internal.h"
#include "tools/viewer/wish_internal.h"

namespace ossa::viewer {
namespace {

namespace beast = boost::beast;
namespace websocket = beast::websocket;
using Clock = std::chrono::steady_clock;

websocket::stream_base::timeout Timeouts() {
  constexpr std::chrono::seconds kSilence{30};  // pages ask every two seconds; by hand
  websocket::stream_base::timeout timeout{};
  timeout.handshake_timeout = kPatience;
  timeout.idle_timeout = kSilence;
  timeout.keep_alive_pings = true;
  return timeout;
}

// A page asks, is answered, and asks again: who is slow gets fewer, and nothing waits in store.
class SocketSession : public std::enable_shared_from_this<SocketSession> {
 public:
  SocketSession(Server& server, Stream stream, Request request)
      : server_(server), socket_(std::move(stream)), request_(std::move(request)) {}

  void Start() {
    constexpr size_t kLongestWish = 4096;  // bytes, by hand: ten times what a page says
    socket_.set_option(Timeouts());
    socket_.read_message_max(kLongestWish);
    socket_.auto_fragment(false);
    socket_.async_accept(request_, [self = shared_from_this()](beast::error_code error) {
      if (!error) self->Read();
    });
  }

 private:
  void Read() {
    buffer_.clear();
    socket_.async_read(buffer_, [self = shared_from_this()](beast::error_code error, size_t) {
      if (!error) self->Handle(beast::buffers_to_string(self->buffer_.data()));
    });
  }

  void Handle(const std::string& text) {
    Desk& desk = server_.desk();
    try {
      const Wish wish = ReadWish(text, desk);
      if (wish.settings) desk.ChangeSettings(*wish.settings);
      if (wish.record) desk.recorder.Ask(*wish.record);
      if (wish.frame) return SayFrame(*wish.frame, wish.step);
      if (wish.after) return SayNewer(*wish.after, wish.step, Clock::now());
      SayState();
    } catch (const InputError& error) {
      const nlohmann::json json = {{"error", error.what()}};
      Write(false, json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
    }
  }

  void SayState() { Write(false, server_.desk().StateJson()); }

  void SayFrame(int64_t number, int step) {
    const auto packed = server_.desk().store.At(number);
    if (!packed) return SayState();
    Write(true, MessageOf(*packed, number, step, server_.desk().StateJson()));
  }

  void SayNewer(int64_t than, int step, Clock::time_point asked) {
    const int64_t newest = server_.desk().store.count().frames - 1;
    if (newest >= 0 && newest != than) return SayFrame(newest, step);
    if (Clock::now() - asked > std::chrono::seconds(1)) return SayState();
    server_.WaitForBell(
        [self = shared_from_this(), than, step, asked] { self->SayNewer(than, step, asked); });
  }

  void Write(bool binary, std::string bytes) {
    out_ = std::move(bytes);
    socket_.binary(binary);
    socket_.async_write(boost::asio::buffer(out_),
                        [self = shared_from_this()](beast::error_code error, size_t) {
                          if (!error) self->Read();
                        });
  }

  Server& server_;
  websocket::stream<Stream> socket_;
  Request request_;
  beast::flat_buffer buffer_;
  std::string out_;
};

}  // namespace

void StartSocket(Server& server, Stream stream, Request request) {
  std::make_shared<SocketSession>(server, std::move(stream), std::move(request))->Start();
}

}  // namespace ossa::viewer
