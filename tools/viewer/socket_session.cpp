#include <algorithm>
#include <array>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <nlohmann/json.hpp>
#include <ratio>
#include <string>
#include <string_view>
#include <utility>

#include "depth/base/error.h"
#include "tools/viewer/message_internal.h"
#include "tools/viewer/page_request_internal.h"
#include "tools/viewer/session_internal.h"

namespace ossa::viewer {
namespace {

namespace beast = boost::beast;
namespace websocket = beast::websocket;
using Clock = std::chrono::steady_clock;

websocket::stream_base::timeout Timeouts() {
  constexpr std::chrono::seconds kSilence{30};  // pages send a request every two seconds; by hand
  websocket::stream_base::timeout timeout{};
  timeout.handshake_timeout = kPatience;
  timeout.idle_timeout = kSilence;
  timeout.keep_alive_pings = true;
  return timeout;
}

// When a page may get the next picture of a camera: slightly more often than a Kinect delivers one,
// so that none is missed. A faster rate would cost time without being visible.
class Pace {
 public:
  Clock::time_point next() const { return next_; }
  // After a late picture the next one may come sooner.
  void Take(Clock::time_point now) { next_ = std::max(next_, now - kPeriod) + kPeriod; }

 private:
  static constexpr Clock::duration kPeriod =
      std::chrono::duration_cast<Clock::duration>(std::chrono::duration<int, std::ratio<1, 32>>(1));
  Clock::time_point next_;
};

// One request, one answer at a time: a slow page gets fewer frames, and nothing is queued.
class SocketSession : public std::enable_shared_from_this<SocketSession> {
 public:
  SocketSession(Server& server, Stream stream, Request request)
      : server_(server),
        socket_(std::move(stream)),
        request_(std::move(request)),
        timer_(server.context()) {}

  void Start() {
    constexpr size_t kLongestRequest = 4096;  // bytes, by hand: ten times the usual
    socket_.set_option(Timeouts());
    socket_.read_message_max(kLongestRequest);
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
    SharedState& shared = server_.shared();
    try {
      const PageRequest page_request = ParsePageRequest(text, shared);
      if (page_request.settings) shared.ChangeSettings(*page_request.settings);
      if (page_request.record) shared.recorder.Request(*page_request.record);
      if (page_request.frame) return SendFrame(*page_request.frame, page_request.step);
      if (page_request.after)
        return SendNewerFrame(*page_request.after, page_request.step, Clock::now());
      SendState();
    } catch (const InputError& error) {
      const nlohmann::json json = {{"error", error.what()}};
      Write(false, json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
    }
  }

  void SendState() { Write(false, server_.shared().StateJson()); }

  void SendFrame(int64_t number, int step) {
    packed_ = server_.shared().store.At(number);
    if (!packed_) return SendState();
    thinned_ = step > 1 ? ThinPictures(*packed_, step) : std::string();
    Write(true, HeadOf(*packed_, number, step, server_.shared().StateJson()),
          step > 1 ? thinned_ : packed_->pictures, packed_->meshes);
  }

  void SendNewerFrame(int64_t than, int step, Clock::time_point requested) {
    const auto now = Clock::now();
    const auto again = [self = shared_from_this(), than, step, requested] {
      self->SendNewerFrame(than, step, requested);
    };
    const int64_t newest = server_.shared().store.count().frames - 1;
    if (newest < 0 || newest == than) {
      if (now - requested > std::chrono::seconds(1)) return SendState();
      return server_.WaitForUpdate(again);
    }
    if (now < pace_.next()) return WaitUntil(pace_.next(), again);
    pace_.Take(now);
    SendFrame(newest, step);
  }

  template <typename Then>
  void WaitUntil(Clock::time_point time, Then then) {
    timer_.expires_at(time);
    timer_.async_wait([then](beast::error_code error) {
      if (!error) then();
    });
  }

  // Pictures and meshes are sent without a copy, shared by several pages.
  void Write(bool binary, std::string head, std::string_view pictures = {},
             std::string_view meshes = {}) {
    head_ = std::move(head);
    const std::array<boost::asio::const_buffer, 3> pieces = {
        boost::asio::buffer(head_), boost::asio::buffer(pictures), boost::asio::buffer(meshes)};
    socket_.binary(binary);
    socket_.async_write(pieces, [self = shared_from_this()](beast::error_code error, size_t) {
      self->packed_.reset();
      if (!error) self->Read();
    });
  }

  Server& server_;
  websocket::stream<Stream> socket_;
  Request request_;
  beast::flat_buffer buffer_;
  boost::asio::steady_timer timer_;
  Pace pace_;
  std::shared_ptr<const PackedFrame> packed_;  // kept until it is sent
  std::string head_, thinned_;
};

}  // namespace

void StartSocket(Server& server, Stream stream, Request request) {
  std::make_shared<SocketSession>(server, std::move(stream), std::move(request))->Start();
}

}  // namespace ossa::viewer
