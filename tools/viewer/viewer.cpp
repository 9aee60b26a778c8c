#include "tools/viewer/viewer.h"

#include <httplib.h>

#include <algorithm>
#include <chrono>
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
  impl_->server.stop();
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
  json["skeletons"] = nlohmann::json::parse(recon::SkeletonJsonLine(skeletons));
  std::string grey = GreyImage(frame);
  const std::lock_guard lock(impl_->mutex);
  json["number"] = impl_->number++;
  impl_->frame_json = json.dump();
  impl_->grey = std::move(grey);
}

}  // namespace ossa::viewer
