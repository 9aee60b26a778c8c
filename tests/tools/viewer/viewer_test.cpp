#include "tools/viewer/viewer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "depth/base/error.h"
#include "depth/sensor/frame_source.h"
#include "tests/support/depth_examples.h"
#include "tests/support/temporary_folder.h"
#include "tests/tools/viewer/example_display_frames.h"
#include "tests/tools/viewer/web_client.h"
#include "tools/viewer/playback_clock.h"

namespace ossa::viewer {
namespace {

using std::chrono::milliseconds;

std::string DepthBytes(int index) {
  const std::vector<uint16_t> mm = test::ExampleFrame(index).depth_mm;
  return {reinterpret_cast<const char*>(mm.data()), mm.size() * sizeof(uint16_t)};
}

TEST(Viewer, AnswersOnlyThisMachineAndItsOwnOrigin) {
  const Viewer viewer(AnyPort());
  for (const char* host : {"127.0.0.1", "localhost", "localhost:9000", "[::1]:9000"}) {
    const auto request = std::string("GET /state HTTP/1.1\r\nHost: ") + host;
    EXPECT_EQ(AnswerTo(viewer.port(), request), "HTTP/1.1 200 OK") << host;
  }
  for (const char* host : {"evil.example", "192.168.1.7", "[fe80::1]:80"}) {
    const auto request = std::string("GET /state HTTP/1.1\r\nHost: ") + host;
    EXPECT_EQ(AnswerTo(viewer.port(), request), "HTTP/1.1 403 Forbidden") << host;
  }
}

TEST(Viewer, RefusesLargeRequests) {
  const Viewer viewer(AnyPort());
  EXPECT_EQ(AnswerTo(viewer.port(),
                     "GET /state HTTP/1.1\r\nHost: localhost\r\nContent-Length: 1200000000"),
            "HTTP/1.1 413 Payload Too Large");
  EXPECT_EQ(AnswerTo(viewer.port(), "GET /" + std::string(20000, 'x') + " HTTP/1.1"),
            "HTTP/1.1 431 Request Header Fields Too Large");
  EXPECT_EQ(AnswerTo(viewer.port(), "\x16\x03\x01 no HTTP"), "HTTP/1.1 400 Bad Request");
}

TEST(Viewer, RequiresTheTokenFromOtherMachines) {
  ViewerOptions options = AnyPort();
  options.address = "0.0.0.0";
  EXPECT_THROW(Viewer{options}, InputError);
  options.token = "s3cret";
  const Viewer viewer(options);
  const std::string get = "GET ", rest = " HTTP/1.1\r\nHost: 192.168.1.7:8080";
  EXPECT_EQ(AnswerTo(viewer.port(), get + "/state" + rest), "HTTP/1.1 401 Unauthorized");
  EXPECT_EQ(AnswerTo(viewer.port(), get + "/state?token=s3creT" + rest),
            "HTTP/1.1 401 Unauthorized");
  EXPECT_EQ(AnswerTo(viewer.port(), get + "/state?token=s3cret" + rest), "HTTP/1.1 200 OK");
  const auto with_cookie = [&](int port) {
    return get + "/state" + rest + "\r\nCookie: a=b; ossa_token_" + std::to_string(port) +
           "=s3cret";
  };
  EXPECT_EQ(AnswerTo(viewer.port(), with_cookie(viewer.port())), "HTTP/1.1 200 OK");
  EXPECT_EQ(AnswerTo(viewer.port(), with_cookie(viewer.port() + 1)), "HTTP/1.1 401 Unauthorized")
      << "that of another viewer of this machine, which a browser sends, too";
  EXPECT_EQ(AnswerTo(viewer.port(), get + "/state?token=s3cret HTTP/1.1\r\nHost: evil.example"),
            "HTTP/1.1 403 Forbidden");
  EXPECT_NE(viewer.urls().front().find("?token=s3cret"), std::string::npos);
}

std::string RefusalAt(const std::string& address, int port) {
  ViewerOptions options = AnyPort();
  options.address = address;
  options.port = port;
  options.token = "s3cret";
  try {
    const Viewer viewer(options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Viewer, ReportsWhyItCannotServe) {
  const Viewer viewer(AnyPort());
  EXPECT_NE(RefusalAt("127.0.0.1", viewer.port()).find("it is taken"), std::string::npos);
  // An address reserved for documentation (RFC 5737), which no machine has.
  const std::string elsewhere = RefusalAt("192.0.2.7", 0);
  EXPECT_NE(elsewhere.find("192.0.2.7: expected an IP address of this machine"), std::string::npos)
      << elsewhere;
}

TEST(Viewer, RefusesAWebSocketOfAnotherOrigin) {
  const Viewer viewer(AnyPort());
  const std::string upgrade =
      "GET /socket HTTP/1.1\r\nHost: localhost\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
      "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nOrigin: ";
  EXPECT_EQ(AnswerTo(viewer.port(), upgrade + "http://evil.example"), "HTTP/1.1 403 Forbidden");
  EXPECT_EQ(AnswerTo(viewer.port(), upgrade + "http://localhost"),
            "HTTP/1.1 101 Switching Protocols");
}

TEST(Viewer, SendsEveryFrameOfARecordingWithItsOwnSkeletons) {
  Viewer viewer(AnyPort(true));
  for (int f = 0; f < 12; ++f) viewer.Show(ExampleDisplayFrame(f));
  viewer.Complete();
  PageClient page(viewer.port());
  for (const int f : {7, 0, 11, 3}) {
    const std::string message = page.Ask("{\"frame\":" + std::to_string(f) + "}");
    ASSERT_TRUE(page.heard_binary());
    const nlohmann::json header = HeaderOf(message);
    EXPECT_EQ(header["number"], f);
    EXPECT_EQ(header["layers"]["final"]["frame"], f);
    EXPECT_EQ(PicturesOf(message).substr(0, DepthBytes(f).size()), DepthBytes(f));
    EXPECT_EQ(PicturesOf(message).back(), static_cast<char>(f % 31 + 1)) << "of its parts";
  }
  const auto state = nlohmann::json::parse(page.Ask(R"({"frame":12})"));
  EXPECT_EQ(state["frames"], 12) << "there is no such frame: the state says how many there are";
  EXPECT_EQ(state["complete"], true);
}

// To a phone every second pixel is sent.
TEST(Viewer, SendsReducedImagesOnRequest) {
  Viewer viewer(AnyPort());
  viewer.Show(ExampleDisplayFrame(5));
  PageClient page(viewer.port());
  const std::string message = page.Ask(R"({"after":-1,"step":2})");
  EXPECT_EQ(HeaderOf(message)["width"], 16);
  const std::string pictures = PicturesOf(message);
  ASSERT_EQ(pictures.size(), 16u * 12 * 4);
  EXPECT_EQ(pictures.substr(2, 2), DepthBytes(5).substr(4, 2)) << "the third pixel is the second";
}

// Encoding a picture takes processor time from the tracker: its rate is limited.
TEST(Viewer, LimitsThePictureRateToThatOfTheCamera) {
  constexpr int kPictures = 20;
  Viewer viewer(AnyPort());
  std::atomic<bool> done = false;
  std::thread tracker([&] {
    for (int f = 0; !done; ++f) viewer.Show(ExampleDisplayFrame(f));
  });
  const auto begin = std::chrono::steady_clock::now();
  PageClient page(viewer.port());
  int64_t last = -1;
  for (int i = 0; i < kPictures; ++i) {
    const std::string message = page.Ask("{\"after\":" + std::to_string(last) + "}");
    ASSERT_TRUE(page.heard_binary());
    EXPECT_GT(HeaderOf(message)["number"], last);
    last = HeaderOf(message)["number"];
  }
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  done = true;
  tracker.join();
  EXPECT_GT(took.count(), (kPictures - 2) / 32.0) << "two may come at once, after that 32 a second";
}

TEST(Viewer, SendsTheNewestFrameOfACameraOnce) {
  Viewer viewer(AnyPort());
  viewer.Show(ExampleDisplayFrame(0));
  viewer.Show(ExampleDisplayFrame(1));
  PageClient page(viewer.port());
  EXPECT_EQ(HeaderOf(page.Ask(R"({"after":-1})"))["number"], 1);
  page.Say(R"({"after":1})");
  std::this_thread::sleep_for(milliseconds(50));
  viewer.Show(ExampleDisplayFrame(2));
  EXPECT_EQ(HeaderOf(page.Hear())["layers"]["final"]["frame"], 2);
  const auto state = nlohmann::json::parse(page.Ask(R"({"after":2})"));
  EXPECT_EQ(state["frames"], 3) << "nothing came within a second";
}

TEST(Viewer, ReportsInvalidRequests) {
  ViewerOptions options = AnyPort();
  options.settings = Settings{.method = "best", .smoothing = ""};
  options.methods = {"best", "holt"};
  Viewer viewer(options);
  PageClient page(viewer.port());
  for (const char* page_request :
       {"", "[]", "{", R"({"frame":-1})", R"({"frame":1.5})", R"({"after":"x"})", R"({"step":9})",
        R"({"settings":{"method":"magic"}})", R"({"settings":{"users":0}})", R"({"settings":[]})",
        R"({"record":1})"}) {
    EXPECT_TRUE(nlohmann::json::parse(page.Ask(page_request)).contains("error")) << page_request;
  }
  EXPECT_FALSE(viewer.TakeSettings());
}

TEST(Viewer, HandsOutNewSettingsOnce) {
  ViewerOptions options = AnyPort();
  options.settings = Settings{.method = "best", .smoothing = ""};
  options.methods = {"best", "holt"};
  Viewer viewer(options);
  PageClient page(viewer.port());
  const auto state =
      nlohmann::json::parse(page.Ask(R"({"settings":{"method":"holt","seated":true,"users":2}})"));
  EXPECT_EQ(state["settings"]["method"], "holt");
  const std::optional<Settings> taken = viewer.TakeSettings();
  ASSERT_TRUE(taken);
  EXPECT_EQ(taken->method, "holt");
  EXPECT_TRUE(taken->seated);
  EXPECT_EQ(taken->users, 2);
  EXPECT_FALSE(viewer.TakeSettings());
  viewer.Refuse(Settings{.method = "best", .smoothing = ""}, "no such file");
  EXPECT_EQ(nlohmann::json::parse(page.Ask(R"({"state":true})"))["refused"], "no such file");
}

TEST(Viewer, RecordsOnRequest) {
  const test::TemporaryFolder folder;
  ViewerOptions options = AnyPort();
  options.recordings = folder.path();
  Viewer viewer(options);
  PageClient page(viewer.port());
  page.Ask(R"({"record":true})");
  for (int f = 0; f < 3; ++f) viewer.Show(ExampleDisplayFrame(f));
  const auto state = nlohmann::json::parse(page.Ask(R"({"record":false})"));
  viewer.Show(ExampleDisplayFrame(3));
  const std::string name = state["recording"]["status"];
  const auto source = depth::OpenSource((folder.path() / name).string());
  EXPECT_EQ(source->frame_count(), 3);
  EXPECT_EQ(source->Read(milliseconds(5000)).frame.depth_mm, test::ExampleFrame(0).depth_mm);
}

TEST(Viewer, ExportsASpanInEveryFormat) {
  Viewer viewer(AnyPort(true));
  for (int f = 0; f < 9; ++f) viewer.Show(ExampleDisplayFrame(f));
  const std::string lines = Get(viewer.port(), "/export?format=jsonl&from=2&to=4");
  EXPECT_EQ(std::count(lines.begin(), lines.end(), '\n'), 3) << lines;
  EXPECT_EQ(nlohmann::json::parse(lines.substr(0, lines.find('\n')))["frame"], 2);
  EXPECT_TRUE(Get(viewer.port(), "/export?format=csv&from=2&to=4").find("Head") !=
              std::string::npos);
  EXPECT_NE(Get(viewer.port(), "/export?format=exe&from=2&to=4").find("expected jsonl"),
            std::string::npos);
  EXPECT_NE(Get(viewer.port(), "/export?format=csv&from=x").find("whole number"),
            std::string::npos);
  EXPECT_NE(Get(viewer.port(), "/export?format=csv&from=4&to=2").find("found none"),
            std::string::npos);
}

TEST(Viewer, SendsSolidsWithTheirFrame) {
  Viewer viewer(AnyPort(true));
  DisplayFrame display = ExampleDisplayFrame(0);
  display.solids.push_back(
      {.shape = physics::Shape::kBall, .size_m = {0.5, 0.0, 0.0}, .position_m = {1.0, 0.25, 3.0}});
  viewer.Show(std::move(display));
  PageClient page(viewer.port());
  const auto solid = HeaderOf(page.Ask("{\"frame\":0}"))["solids"][0];
  EXPECT_EQ(solid["shape"], "ball");
  EXPECT_EQ(solid["size"][0], 0.5);
  EXPECT_EQ(solid["at"][2], 3.0);
  EXPECT_EQ(solid["person"], 0);
}

// Upright along y, a metre long: what the page draws is where the bones are.
TEST(Viewer, PlacesACapsuleAlongItsBone) {
  recon::Posture posture;
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    posture.position_m[j] = {0.0, 0.1 * static_cast<double>(j), 2.0};
  }
  const std::vector<Solid> capsules = CapsulesOf(posture, 4);
  ASSERT_EQ(capsules.size(), recon::kJointCount - 1);
  for (const Solid& capsule : capsules) {
    EXPECT_EQ(capsule.person, 4);
    const Eigen::Vector3d along = capsule.orientation * Eigen::Vector3d::UnitY();
    EXPECT_NEAR(std::abs(along.y()), 1.0, 1e-9);
    EXPECT_NEAR(capsule.position_m.z(), 2.0, 1e-9);
  }
}

TEST(Viewer, SendsOverlaysLineByLine) {
  ViewerOptions options = AnyPort(true);
  recon::SkeletonSequence sequence;
  for (int f = 0; f < 3; ++f) sequence.frames.push_back(ExampleDisplayFrame(f).layers[0]);
  options.overlays.push_back({"truth", sequence});
  const Viewer viewer(options);
  const std::string lines = Get(viewer.port(), "/lines?layer=0&from=1");
  EXPECT_EQ(std::count(lines.begin(), lines.end(), '\n'), 2);
  EXPECT_EQ(Get(viewer.port(), "/lines?layer=1"), "");
  EXPECT_EQ(Get(viewer.port(), "/lines?layer=final"), "");
  EXPECT_EQ(Get(viewer.port(), "/lines"), "") << "the final ones, not the first overlay's";
  EXPECT_NE(Get(viewer.port(), "/lines?layer=truth").find("expected final"), std::string::npos);
  EXPECT_NE(Get(viewer.port(), "/lines?layer=0&from=9223372036854775807").find("whole number"),
            std::string::npos);
}

// A camera that was set up again an hour later, and a clock that was put back.
TEST(PlaybackClock, SkipsPausesAndRestartsWhereTimesRunBackwards) {
  PlaybackClock clock;
  const auto start = PlaybackClock::Clock::now();
  const auto is_soon = [&](double time_s) {
    return clock.DueAt(time_s) < start + std::chrono::seconds(10);
  };
  EXPECT_TRUE(is_soon(5000.0));
  const auto due = clock.DueAt(5000.5);
  EXPECT_EQ(clock.DueAt(5000.5), due) << "asked again";
  EXPECT_NEAR(std::chrono::duration<double>(due - start).count(), 0.5, 0.3);
  EXPECT_TRUE(is_soon(8600.0));
  EXPECT_TRUE(is_soon(1.0));
  EXPECT_TRUE(is_soon(1.5));
}

TEST(Viewer, PageReferencesNoOtherHost) {
  const Viewer viewer(AnyPort());
  const Client client(viewer.port());
  client.Say("GET / HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n");
  const std::string all = client.Rest();
  EXPECT_NE(all.find("Content-Security-Policy: default-src 'self'"), std::string::npos);
  EXPECT_NE(all.find("Content-Encoding: gzip"), std::string::npos);
  EXPECT_EQ(AnswerTo(viewer.port(), "GET /page/../viewer.cpp HTTP/1.1\r\nHost: localhost"),
            "HTTP/1.1 404 Not Found");
}

}  // namespace
}  // namespace ossa::viewer
