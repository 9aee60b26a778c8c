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

// When a camera's next picture may go to one page: as often as a Kinect has one, and a little
// oftener, so that none of its frames is missed. What is tracked faster than that would be packed
// and sent for nobody's eyes.
class Pace {
 public:
  Clock::time_point next() const { return next_; }
  // A picture that comes late may be followed sooner.
  void Take(Clock::time_point now) { next_ = std::max(next_, now - kPeriod) + kPeriod; }

 private:
  static constexpr Clock::duration kPeriod =
      std::chrono::duration_cast<Clock::duration>(std::chrono::duration<int, std::ratio<1, 32>>(1));
  Clock::time_point next_;
};

// A page asks, is answered, and asks again: who is slow gets fewer, and nothing waits in store.
class SocketSession : public std::enable_shared_from_this<SocketSession> {
 public:
  SocketSession(Server& server, Stream stream, Request request)
      : server_(server),
        socket_(std::move(stream)),
        request_(std::move(request)),
        timer_(server.context()) {}

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
    packed_ = server_.desk().store.At(number);
    if (!packed_) return SayState();
    thinned_ = step > 1 ? ThinPictures(*packed_, step) : std::string();
    Write(true, HeadOf(*packed_, number, step, server_.desk().StateJson()),
          step > 1 ? thinned_ : packed_->pictures, packed_->meshes);
  }

  void SayNewer(int64_t than, int step, Clock::time_point asked) {
    const auto now = Clock::now();
    const auto again = [self = shared_from_this(), than, step, asked] {
      self->SayNewer(than, step, asked);
    };
    const int64_t newest = server_.desk().store.count().frames - 1;
    if (newest < 0 || newest == than) {
      if (now - asked > std::chrono::seconds(1)) return SayState();
      return server_.WaitForBell(again);
    }
    if (now < pace_.next()) return WaitUntil(pace_.next(), again);
    pace_.Take(now);
    SayFrame(newest, step);
  }

  template <typename Then>
  void WaitUntil(Clock::time_point time, Then then) {
    timer_.expires_at(time);
    timer_.async_wait([then](beast::error_code error) {
      if (!error) then();
    });
  }

  // Pictures and meshes go from where they are, which several pages share.
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
  std::shared_ptr<const PackedMoment> packed_;  // what is sent of, until it is
  std::string head_, thinned_;
};

}  // namespace

void StartSocket(Server& server, Stream stream, Request request) {
  std::make_shared<SocketSession>(server, std::move(stream), std::move(request))->Start();
}

}  // namespace ossa::viewer
