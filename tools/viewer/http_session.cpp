#include <boost/asio/dispatch.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/write.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <optional>

#include "tools/viewer/answer_internal.h"
#include "tools/viewer/session_internal.h"

namespace ossa::viewer {
namespace {

namespace beast = boost::beast;
namespace http = beast::http;
using Response = http::response<http::string_body>;

// The page loads nothing from other hosts, and may not.
constexpr const char* kContentPolicy =
    "default-src 'self'; img-src 'self' blob: data:; connect-src 'self' ws:; frame-ancestors "
    "'none'";

std::string_view View(beast::string_view text) { return {text.data(), text.size()}; }

class HttpSession : public Connection, public std::enable_shared_from_this<HttpSession> {
 public:
  HttpSession(Server& server, Server::Socket socket)
      : server_(server), stream_(std::move(socket)) {}
  ~HttpSession() override { server_.Forget(this); }

  void Start() {
    server_.Register(shared_from_this());
    Read();
  }
  void Close() override {
    beast::error_code ignored;
    stream_.socket().close(ignored);
  }

 private:
  void Read() {
    constexpr uint32_t kLongestHeader = 8192;  // bytes, by convention of servers
    constexpr uint64_t kLongestBody = 1024;    // bytes, by hand: no request has a body
    parser_.emplace();
    parser_->header_limit(kLongestHeader);
    parser_->body_limit(kLongestBody);
    stream_.expires_after(kPatience);
    http::async_read(
        stream_, buffer_, *parser_,
        [self = shared_from_this()](beast::error_code error, size_t) { self->OnRead(error); });
  }

  void OnRead(const beast::error_code& error) {
    if (error == http::error::body_limit) return Refuse(http::status::payload_too_large);
    if (error == http::error::header_limit) {
      return Refuse(http::status::request_header_fields_too_large);
    }
    if (error.category() == make_error_code(http::error::bad_method).category() &&
        error != http::error::end_of_stream && error != http::error::partial_message) {
      return Refuse(http::status::bad_request);
    }
    if (!error) Handle(parser_->release());
  }

  void Handle(Request request) {
    const std::string_view host = View(request[http::field::host]);
    const std::string_view target = View(request.target());
    if (!server_.access().AllowsHost(host)) return Refuse(http::status::forbidden);
    const std::string_view cookies = View(request[http::field::cookie]);
    if (!server_.access().AllowsToken(target, cookies, server_.port())) {
      return Refuse(http::status::unauthorized);
    }
    if (request.method() != http::verb::get) return Refuse(http::status::method_not_allowed);
    const std::string_view path = target.substr(0, target.find('?'));
    if (path == "/socket" && beast::websocket::is_upgrade(request))
      return Upgrade(std::move(request));
    if (path == "/skeletons")
      return HandOver([&](Stream stream) { StartEvents(server_, std::move(stream), request); });
    SendAnswer(AnswerTo(target, server_.shared()), request);
  }

  void Upgrade(Request request) {
    const std::string_view host = View(request[http::field::host]);
    if (!Access::AllowsOrigin(View(request[http::field::origin]), host)) {
      return Refuse(http::status::forbidden);
    }
    HandOver([&](Stream stream) { StartSocket(server_, std::move(stream), std::move(request)); });
  }

  template <typename Taker>
  void HandOver(Taker take) {
    stream_.expires_never();
    server_.Forget(this);
    take(std::move(stream_));
  }

  void Refuse(http::status status) {
    Response response(status, 11);
    response.keep_alive(false);
    response.body() = std::string(View(http::obsolete_reason(status))) + "\n";
    Send(std::move(response));
  }

  void SendAnswer(Answer answer, const Request& request) {
    Response response(static_cast<http::status>(answer.status), request.version());
    response.keep_alive(request.keep_alive());
    response.set(http::field::content_type, answer.type);
    response.set(http::field::cache_control, "no-cache");
    response.set("Content-Security-Policy", kContentPolicy);
    response.set("X-Content-Type-Options", "nosniff");
    response.set("Referrer-Policy", "no-referrer");
    if (answer.gzipped) response.set(http::field::content_encoding, "gzip");
    if (!answer.file_name.empty()) {
      response.set(http::field::content_disposition,
                   "attachment; filename=\"" + answer.file_name + "\"");
    }
    if (!server_.access().token.empty()) {
      response.set(http::field::set_cookie, TokenCookie(server_.port()) + "=" +
                                                server_.access().token +
                                                "; HttpOnly; SameSite=Strict; Path=/");
    }
    response.body() = std::move(answer.body);
    Send(std::move(response));
  }

  void Send(Response response) {
    response_ = std::move(response);
    response_.prepare_payload();
    stream_.expires_after(kPatience);
    http::async_write(stream_, response_,
                      [self = shared_from_this()](beast::error_code error, size_t) {
                        if (!error && self->response_.keep_alive()) return self->Read();
                        beast::error_code ignored;
                        self->stream_.socket().shutdown(Server::Socket::shutdown_send, ignored);
                      });
  }

  Server& server_;
  Stream stream_;
  beast::flat_buffer buffer_{16384};  // bytes: the longest header and what may follow it, by hand
  std::optional<http::request_parser<http::string_body>> parser_;
  Response response_;
};

}  // namespace

void StartHttp(Server& server, Server::Socket socket) {
  std::make_shared<HttpSession>(server, std::move(socket))->Start();
}

}  // namespace ossa::viewer
