#include "tools/viewer/viewer.h"

#include <httplib.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <future>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "depth/base/error.h"
#include "recon/files/skeleton_jsonl.h"
#include "tools/viewer/page_internal.h"

namespace ossa::viewer {
namespace {

// Constants: chosen by hand, where nothing else is said.

// Half the usual image each way: 77 kB a frame to the browser.
constexpr int kThinning = 2;

// Each holds a thread of the eight: the page must have some, too.
constexpr int kMostListeners = 4;

// Near is bright; 0 where nothing was measured.
std::string GreyImage(const depth::DepthFrame& frame) {
  constexpr int kNear_mm = 500, kFar_mm = 5000;
  std::string grey;
  for (int v = 0; v < frame.camera.height; v += kThinning) {
    for (int u = 0; u < frame.camera.width; u += kThinning) {
      const int mm = frame.view().at(u, v);
      const int share = 255 * (std::clamp(mm, kNear_mm, kFar_mm) - kNear_mm) / (kFar_mm - kNear_mm);
      grey.push_back(mm == 0 ? '\0'
                             : static_cast<char>(static_cast<uint8_t>(240 - share * 200 / 255)));
    }
  }
  return grey;
}

// A page of this machine, such as one under development, may read events; one from elsewhere may
// not.
void AllowPagesOfThisMachine(const httplib::Request& request, httplib::Response& response) {
  const std::string origin = request.get_header_value("Origin");
  for (const char* host : {"http://localhost", "http://127.0.0.1"}) {
    const std::string_view rest = std::string_view(origin).substr(
        origin.starts_with(host) ? std::string_view(host).size() : 0);
    if (!origin.starts_with(host) || (!rest.empty() && rest.front() != ':')) continue;
    response.set_header("Access-Control-Allow-Origin", origin);
  }
}

// Pages elsewhere can make a browser ask this machine under a name of theirs (DNS rebinding).
bool IsForThisMachine(const httplib::Request& request) {
  std::string host = request.get_header_value("Host");
  if (host.empty()) return true;  // no browser
  const size_t colon = host.rfind(':');
  if (colon != std::string::npos && host.find(']', colon) == std::string::npos) host.resize(colon);
  return host == "127.0.0.1" || host == "localhost" || host == "[::1]";
}

// A browser holds some connections in store. One that sends nothing, or hardly anything, may keep
// its thread from the others for a moment only.
void LimitClients(httplib::Server& server) {
  constexpr size_t kThreads = 8, kLongestRequest = 1024;
  server.new_task_queue = [] { return new httplib::ThreadPool(kThreads); };
  server.set_keep_alive_timeout(1);
  server.set_read_timeout(std::chrono::milliseconds(300));
  server.set_write_timeout(std::chrono::milliseconds(1000));
  server.set_payload_max_length(kLongestRequest);
  server.set_pre_routing_handler([](const httplib::Request& request, httplib::Response& response) {
    if (IsForThisMachine(request)) return httplib::Server::HandlerResponse::Unhandled;
    response.status = 403;
    return httplib::Server::HandlerResponse::Handled;
  });
}

}  // namespace

struct Viewer::Impl {
  httplib::Server server;
  std::thread thread;
  std::promise<void> ended;
  int port = 0;
  std::mutex mutex;  // guards what follows
  std::string frame_json = R"({"number":-1})";
  std::string grey;
  int64_t number = 0;
  std::condition_variable changed;  // `number`, or `stopping`
  std::string skeletons_json;       // the newest frame's
  int listeners = 0;                // of events
  bool stopping = false;

  // What an event stream gets next: the newest skeletons once they are others than `seen`, or a
  // comment after a second of none, which tells whether anybody is there. False at the end.
  bool NextEvent(int64_t& seen, std::string& event) {
    std::unique_lock lock(mutex);
    const bool is_new =
        changed.wait_for(lock, std::chrono::seconds(1), [&] { return stopping || number != seen; });
    if (stopping) return false;
    event = is_new ? "data: " + skeletons_json + "\n\n" : ": \n\n";
    seen = number;
    return true;
  }

  // Server-sent events (HTML standard, 9.2): a line of skeleton JSONL each. A slow reader misses
  // frames, not time.
  void ServeSkeletons(const httplib::Request& request, httplib::Response& response) {
    AllowPagesOfThisMachine(request, response);
    {
      const std::lock_guard lock(mutex);
      if (listeners == kMostListeners) {
        response.status = 503;
        return;
      }
      ++listeners;
    }
    response.set_chunked_content_provider(
        "text/event-stream",
        [this, seen = int64_t{0}](size_t, httplib::DataSink& sink) mutable {
          std::string event;
          return NextEvent(seen, event) && sink.write(event.data(), event.size());
        },
        [this](bool) {
          const std::lock_guard lock(mutex);
          --listeners;
        });
  }

  void Stop() {
    {
      const std::lock_guard lock(mutex);
      stopping = true;
    }
    changed.notify_all();
    server.stop();
  }

  void Serve() {
    server.Get("/", [](const httplib::Request&, httplib::Response& response) {
      response.set_content(kPage, "text/html; charset=utf-8");
    });
    server.Get("/frame", [this](const httplib::Request&, httplib::Response& response) {
      const std::lock_guard lock(mutex);
      response.set_content(frame_json, "application/json");
    });
    server.Get("/depth", [this](const httplib::Request&, httplib::Response& response) {
      const std::lock_guard lock(mutex);
      response.set_content(grey, "application/octet-stream");
    });
    server.Get("/skeletons", [this](const httplib::Request& request, httplib::Response& response) {
      ServeSkeletons(request, response);
    });
    thread = std::thread([this] {
      server.listen_after_bind();
      ended.set_value();
    });
  }
};

Viewer::Viewer(int port) : impl_(std::make_unique<Impl>()) {
  LimitClients(impl_->server);
  // The default shares the port with whoever listens already; a taken port must be an error.
  impl_->server.set_socket_options([](auto socket) {
    const int yes = 1;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
  });
  const bool any = port == 0;
  const int bound = any ? impl_->server.bind_to_any_port("127.0.0.1")
                        : (impl_->server.bind_to_port("127.0.0.1", port) ? port : -1);
  if (bound < 0) {
    throw InputError("port " + std::to_string(port) +
                     ": expected a free port on 127.0.0.1, it is taken");
  }
  impl_->port = bound;
  impl_->Serve();
  while (!impl_->server.is_running()) std::this_thread::yield();
}

Viewer::~Viewer() {
  impl_->Stop();
  if (impl_->ended.get_future().wait_for(std::chrono::seconds(2)) == std::future_status::ready) {
    impl_->thread.join();
    return;
  }
  // A client goes on sending a byte now and then. The program must end all the same; what serves
  // the client is left to the end of the process.
  impl_->thread.detach();
  static_cast<void>(impl_.release());
}

int Viewer::port() const { return impl_->port; }

void Viewer::Show(const depth::DepthFrame& frame, const recon::SkeletonFrame& skeletons) {
  const depth::Camera& camera = frame.camera;
  nlohmann::json json = {{"width", (camera.width + kThinning - 1) / kThinning},
                         {"height", (camera.height + kThinning - 1) / kThinning},
                         {"camera",
                          {{"width", camera.width},
                           {"height", camera.height},
                           {"fx", camera.fx},
                           {"fy", camera.fy},
                           {"cx", camera.cx},
                           {"cy", camera.cy}}}};
  std::string line = recon::SkeletonJsonLine(skeletons);
  json["skeletons"] = nlohmann::json::parse(line);
  std::string grey = GreyImage(frame);
  const std::lock_guard lock(impl_->mutex);
  json["number"] = impl_->number++;
  impl_->frame_json = json.dump();
  impl_->grey = std::move(grey);
  impl_->skeletons_json = std::move(line);
  impl_->changed.notify_all();
}

}  // namespace ossa::viewer
