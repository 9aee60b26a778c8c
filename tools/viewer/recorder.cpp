#include "tools/viewer/recorder_internal.h"

#include <fmt/chrono.h>

#include <ctime>
#include <utility>

#include "depth/base/atomic_file.h"

namespace ossa::viewer {

Recorder::Recorder(std::optional<std::filesystem::path> folder) : folder_(std::move(folder)) {}

Recorder::~Recorder() {
  const std::lock_guard lock(mutex_);
  try {
    End();
  } catch (const InputError&) {
    // The disk is full and the program ends: there is nobody to tell.
    writing_.reset();
  }
}

void Recorder::Ask(bool on) {
  const std::lock_guard lock(mutex_);
  asked_ = on && possible();
}

bool Recorder::asked() const {
  const std::lock_guard lock(mutex_);
  return asked_;
}

std::string Recorder::said() const {
  const std::lock_guard lock(mutex_);
  return said_;
}

void Recorder::Begin(const depth::DepthFrame& frame) {
  const std::time_t now = std::time(nullptr);
  const std::string name = fmt::format("ossa-{:%Y%m%d-%H%M%S}.oni", fmt::localtime(now));
  writing_ = std::make_unique<depth::OniRecorder>(*folder_ / name, frame.camera);
  said_ = name;
}

void Recorder::End() {
  if (!writing_) return;
  writing_->Finish();
  writing_.reset();
}

void Recorder::Try(const depth::DepthFrame& frame) {
  if (!asked_) return End();
  if (!writing_) Begin(frame);
  writing_->Write(frame);
}

void Recorder::Take(const depth::DepthFrame& frame) {
  const std::lock_guard lock(mutex_);
  try {
    Try(frame);
  } catch (const DiskFull& full) {
    said_ += writing_ && writing_->FinishWithWhatFits() > 0 ? ": what fits on the disk is kept"
                                                            : std::string(": ") + full.what();
    asked_ = false;
    writing_.reset();
  } catch (const InputError& error) {
    said_ = error.what();
    asked_ = false;
    writing_.reset();
  }
}

}  // namespace ossa::viewer
