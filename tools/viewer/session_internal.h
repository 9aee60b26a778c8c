#pragma once
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <chrono>

#include "tools/viewer/server_internal.h"

namespace ossa::viewer {

// Constants: timeouts of one client in seconds, by hand.

using Stream = boost::beast::basic_stream<boost::asio::generic::stream_protocol>;
using Request = boost::beast::http::request<boost::beast::http::string_body>;

/// For a whole request, and for written data to be received.
inline constexpr std::chrono::seconds kPatience{5};

/// Reads requests from the socket and answers them; hands the stream over to one of the sessions
/// below on request.
void StartHttp(Server& server, Server::Socket socket);

/// WebSocket: requests in, messages out (page_request_internal.h, message_internal.h).
void StartSocket(Server& server, Stream stream, Request request);

/// Server-sent events (HTML standard, 9.2): a line of skeleton JSONL each. Of a camera the newest,
/// of a recording at its own speed, looped. For a slow reader frames are dropped, not delayed.
void StartEvents(Server& server, Stream stream, const Request& request);

}  // namespace ossa::viewer
