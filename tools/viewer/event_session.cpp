#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <utility>

#include "tools/viewer/playback_clock.h"
#include "tools/viewer/session_internal.h"

namespace ossa::viewer {
namespace {

namespace asio = boost::asio;
namespace http = boost::beast::http;
using Clock = PlaybackClock::Clock;

class EventSession : public std::enable_shared_from_this<EventSession> {
 public:
  EventSession(Server& server, Stream stream)
      : server_(server), stream_(std::move(stream)), timer_(server.context()) {}

  void Start(const std::string& origin) {
    std::string head =
        "HTTP/1.1 200 OK\r\nContent-Type: text/event-stream\r\nCache-Control: no-cache\r\n"
        "Connection: close\r\n";
    if (IsPageOfThisMachine(origin)) head += "Access-Control-Allow-Origin: " + origin + "\r\n";
    Write(head + "\r\n");
  }

 private:
  // Sends the lines that are due; else waits for an update.
  void Next() {
    const FrameStore& store = server_.shared().store;
    const FrameStore::Count count = store.count();
    if (count.generation != generation_) Rewind(count.generation);
    if (!store.keeps()) {
      if (count.frames == next_) return Wait();
      next_ = count.frames;
      return Write("data: " + store.Line(next_ - 1) + "\n\n");
    }
    if (next_ >= count.frames && count.complete && count.frames > 0) return PlayAgain();
    if (next_ >= count.frames) {
      clock_.Restart();  // the tracker is slower than the recording
      return Wait();
    }
    Play(store);
  }

  void Rewind(int64_t generation) {
    generation_ = generation;
    next_ = 0;
    clock_.Restart();
  }

  void PlayAgain() {
    Rewind(generation_);
    After(Clock::now() + PlaybackClock::LastFramesTime());
  }

  void Play(const FrameStore& store) {
    const Clock::time_point due = clock_.DueAt(store.TimeOf(next_));
    if (due > Clock::now()) return After(due);
    Write("data: " + store.Line(next_++) + "\n\n");
  }

  void After(Clock::time_point when) {
    timer_.expires_at(when);
    timer_.async_wait([self = shared_from_this()](const boost::system::error_code& error) {
      if (!error) self->Next();
    });
  }

  // A comment after a second without events detects closed connections.
  void Wait() {
    const Clock::time_point begun = Clock::now();
    server_.WaitForUpdate([self = shared_from_this(), begun] {
      if (Clock::now() - begun < std::chrono::milliseconds(500)) return self->Next();
      self->Write(": \n\n");
    });
  }

  void Write(std::string text) {
    text_ = std::move(text);
    stream_.expires_after(kPatience);
    asio::async_write(stream_, asio::buffer(text_),
                      [self = shared_from_this()](const boost::system::error_code& error, size_t) {
                        if (!error) self->Next();
                      });
  }

  Server& server_;
  Stream stream_;
  asio::steady_timer timer_;
  std::string text_;
  int64_t next_ = 0, generation_ = 0;
  PlaybackClock clock_;
};

}  // namespace

void StartEvents(Server& server, Stream stream, const Request& request) {
  const auto origin = request[http::field::origin];
  std::make_shared<EventSession>(server, std::move(stream))
      ->Start(std::string(origin.data(), origin.size()));
}

}  // namespace ossa::viewer
