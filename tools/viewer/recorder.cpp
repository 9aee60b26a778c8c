#include "tools/viewer/recorder_internal.h"

#include <fmt/chrono.h>

#include <system_error>
#include <utility>

#include "depth/base/atomic_file.h"

namespace ossa::viewer {

std::string NameOfNewFile(const std::filesystem::path& folder, std::time_t now) {
  const std::string stem = fmt::format("ossa-{:%Y%m%d-%H%M%S}", fmt::localtime(now));
  std::string name = stem + ".oni";
  std::error_code unknown;
  const auto is_taken = [&] {
    return std::filesystem::exists(std::filesystem::symlink_status(folder / name, unknown));
  };
  for (int i = 2; is_taken(); ++i) {
    name = fmt::format("{}-{}.oni", stem, i);
  }
  return name;
}

Recorder::Recorder(std::optional<std::filesystem::path> folder) : folder_(std::move(folder)) {}

Recorder::~Recorder() {
  const std::lock_guard lock(mutex_);
  AbortOnError([this] { End(); });
}

void Recorder::Request(bool on) {
  const std::lock_guard lock(mutex_);
  requested_ = on && possible();
}

bool Recorder::requested() const {
  const std::lock_guard lock(mutex_);
  return requested_;
}

std::string Recorder::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

void Recorder::Begin(const depth::DepthFrame& frame) {
  const std::string name = NameOfNewFile(*folder_, std::time(nullptr));
  writing_ = std::make_unique<depth::OniRecorder>(*folder_ / name, frame.camera);
  status_ = name;
}

void Recorder::End() {
  if (!writing_) return;
  writing_->Finish();
  writing_.reset();
}

void Recorder::WriteFrame(const depth::DepthFrame& frame) {
  if (!requested_) return End();
  if (!writing_) Begin(frame);
  writing_->Write(frame);
}

void Recorder::Abort(const std::string& why) {
  const std::string name = status_;
  status_ = why;
  requested_ = false;
  try {
    const int64_t kept = writing_ ? writing_->FinishWithWhatFits() : 0;
    if (kept > 0) status_ += fmt::format("; the {} frames before are in {}", kept, name);
  } catch (const InputError& error) {
    status_ += std::string("; nothing is kept: ") + error.what();
  }
  writing_.reset();
}

void Recorder::AbortOnError(const std::function<void()>& step) {
  try {
    step();
  } catch (const InputError& error) {
    Abort(error.what());
  }
}

void Recorder::Take(const depth::DepthFrame& frame) {
  const std::lock_guard lock(mutex_);
  AbortOnError([&] { WriteFrame(frame); });
}

}  // namespace ossa::viewer
