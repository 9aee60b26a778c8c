#include "tools/stream/sender.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "recon/files/skeleton_jsonl.h"
#include "tools/stream/packets.h"
#include "tools/stream/udp_socket_internal.h"
#include "tools/stream/unity_humanoid.h"
#include "tools/tracker/skeleton_record.h"

namespace ossa::stream {
namespace {

constexpr size_t kMostPeople = 6;  // by definition of the tracker

}  // namespace

struct Sender::Impl {
  struct Line {
    Target target;
    UdpSocket socket;
  };
  std::vector<Line> lines;
  UnityRoom room;
  std::optional<double> first_s;  // when the first frame was taken: a float holds what follows
  std::array<int, kMostPeople> people{};  // body ids by port; 0: free
  int of_vrchat = 0;                      // the body that VRChat gets; 0: none yet
  double of_vrchat_seen_s = 0.0;

  void Seat(const tracker::BodyFrame& frame);
  void ChooseForVrchat(double time_s);
  void SendPerson(const tracker::Body& body, size_t seat, double time_s);
};

Sender::Sender(const std::vector<Target>& targets) : impl_(std::make_unique<Impl>()) {
  for (const Target& target : targets) {
    if (target.protocol != Protocol::kJsonl) CheckHasOsc();
    impl_->lines.push_back({target, UdpSocket(target)});
  }
}
Sender::~Sender() = default;
Sender::Sender(Sender&&) noexcept = default;
Sender& Sender::operator=(Sender&&) noexcept = default;

// People who left free their slots; new people take the first free one.
void Sender::Impl::Seat(const tracker::BodyFrame& frame) {
  for (int& id : people) {
    const bool here = std::any_of(frame.bodies.begin(), frame.bodies.end(),
                                  [&](const tracker::Body& body) { return body.id == id; });
    if (!here) id = 0;
  }
  for (const tracker::Body& body : frame.bodies) {
    if (std::find(people.begin(), people.end(), body.id) != people.end()) continue;
    const auto seat = std::find(people.begin(), people.end(), 0);
    if (seat != people.end()) *seat = body.id;
  }
}

// After Seat(). VRChat shows one body: the first person's. If that person is gone, a person in the
// same slot replaces it (the same person under a new id, or another one); else the next person
// after a while, so that a short false detection does not leave VRChat without a body.
void Sender::Impl::ChooseForVrchat(double time_s) {
  constexpr double kPatience_s = 2.0;  // by hand: people out of view return within this time
  const bool here =
      of_vrchat != 0 && std::find(people.begin(), people.end(), of_vrchat) != people.end();
  if (!here) {
    const auto next = std::find_if(people.begin(), people.end(), [](int id) { return id != 0; });
    if (next == people.end()) return;
    const bool waits = std::abs(time_s - of_vrchat_seen_s) <= kPatience_s;
    if (waits && next != people.begin()) return;
    of_vrchat = *next;
  }
  of_vrchat_seen_s = time_s;
}

void Sender::Impl::SendPerson(const tracker::Body& body, size_t seat, double time_s) {
  const Humanoid world = ComputePose(body, room);
  for (Line& line : lines) {
    if (line.target.protocol == Protocol::kVmc) {
      line.socket.Send(VmcPacket(world, time_s, line.target.seen_only), static_cast<int>(seat));
    }
    if (line.target.protocol == Protocol::kVrchat && body.id == of_vrchat) {
      line.socket.Send(VrchatPacket(world, line.target.scale), 0);
    }
  }
}

void Sender::Send(const tracker::BodyFrame& frame) {
  impl_->room.Update(frame);
  if (!impl_->first_s) impl_->first_s = frame.time_s;
  impl_->Seat(frame);
  impl_->ChooseForVrchat(frame.time_s);
  for (const tracker::Body& body : frame.bodies) {
    const auto seat = std::find(impl_->people.begin(), impl_->people.end(), body.id);
    if (seat == impl_->people.end() || body.state != tracker::BodyState::kTracked) continue;
    impl_->SendPerson(body, static_cast<size_t>(seat - impl_->people.begin()),
                      frame.time_s - *impl_->first_s);
  }
  for (Impl::Line& line : impl_->lines) {
    if (line.target.protocol != Protocol::kJsonl) continue;
    line.socket.Send(recon::SkeletonJsonLine(tracker::ToRecord(frame)), 0);
  }
}

}  // namespace ossa::stream
