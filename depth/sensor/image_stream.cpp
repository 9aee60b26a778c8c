// Depth images that another program sends through a pipe, as it takes them.
#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iomanip>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>

#include "depth/base/error.h"
#include "depth/base/lower_case.h"
#include "depth/base/open_file.h"
#include "depth/image/camera_io.h"
#include "depth/image/number_format.h"
#include "depth/image/pgm_header.h"
#include "depth/sensor/sensor_clock.h"
#include "depth/sensor/source_internal.h"

namespace ossa::depth {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr std::string_view kStandardInput = "-";

// An open file, pipe or socket.
class Descriptor {
 public:
  Descriptor(int fd, bool is_owned) : fd_(fd), is_owned_(is_owned) {}
  Descriptor(Descriptor&& other) noexcept
      : fd_(std::exchange(other.fd_, -1)), is_owned_(other.is_owned_) {}
  Descriptor& operator=(Descriptor&&) = delete;
  ~Descriptor() {
    if (is_owned_ && fd_ >= 0) close(fd_);
  }

  bool IsRegularFile() const {
    struct stat status {};
    return fstat(fd_, &status) == 0 && S_ISREG(status.st_mode);
  }
  bool IsTerminal() const { return isatty(fd_) == 1; }

  enum class Outcome { kRead, kTimeout, kEnd };
  // Appends at most `most` bytes. Throws InputError, `name` first.
  Outcome Append(std::vector<uint8_t>& bytes, size_t most, milliseconds timeout,
                 const std::string& name) const {
    pollfd wanted{.fd = fd_, .events = POLLIN, .revents = 0};
    const int ready = poll(&wanted, 1, static_cast<int>(timeout.count()));
    if (ready == 0 || (ready < 0 && errno == EINTR)) return Outcome::kTimeout;
    const size_t before = bytes.size();
    bytes.resize(before + most);
    const ssize_t got = ready < 0 ? -1 : read(fd_, &bytes[before], most);
    const int failure = errno;
    bytes.resize(before + static_cast<size_t>(std::max<ssize_t>(got, 0)));
    if (got > 0) return Outcome::kRead;
    if (got == 0) return Outcome::kEnd;
    if (failure == EAGAIN || failure == EINTR) return Outcome::kTimeout;
    throw InputError(name + ": cannot be read: " + std::strerror(failure));
  }

 private:
  int fd_;
  bool is_owned_;
};

// What the comments of an image say of it.
struct Remarks {
  std::optional<double> time_s;
  std::optional<CameraChoice> camera;
};

// The rest of a comment that begins with this word; none for others.
std::optional<std::string_view> Behind(std::string_view word, std::string_view comment) {
  if (!comment.starts_with(word) || comment.size() == word.size()) return std::nullopt;
  const size_t value = comment.find_first_not_of(" \t", word.size());
  return value == word.size() ? std::nullopt : std::optional(comment.substr(value));
}

double ParseTime(std::string_view text) {
  constexpr double kLatest_s = 1e11;  // three thousand years; an upper bound
  double time_s = 0.0;
  const auto parsed = std::from_chars(text.data(), text.data() + text.size(), time_s);
  const bool is_time = parsed.ec == std::errc() && parsed.ptr == text.data() + text.size();
  if (is_time && std::abs(time_s) < kLatest_s) return time_s;
  throw InputError("# time_s: expected seconds, found '" + std::string(text) + "'");
}

CameraChoice ParseRemarkedCamera(std::string_view text) {
  try {
    return ParseCamera(std::string(text));
  } catch (const InputError& error) {
    throw InputError(std::string("# camera: ") + error.what());
  }
}

Remarks ParseRemarks(const PgmHeader& header) {
  Remarks remarks;
  for (const std::string& comment : header.comments) {
    if (const auto time = Behind("time_s", comment)) remarks.time_s = ParseTime(*time);
    if (const auto camera = Behind("camera", comment))
      remarks.camera = ParseRemarkedCamera(*camera);
  }
  return remarks;
}

class ImageStream final : public FrameSource {
 public:
  // `folder`: of a file, whose camera may be beside it; else "".
  ImageStream(std::string name, Descriptor input, std::filesystem::path folder,
              const SourceOptions& options)
      : name_(std::move(name)),
        input_(std::move(input)),
        folder_(std::move(folder)),
        is_live_(!input_.IsRegularFile()),
        options_(options) {}

  // Waits for the first image, which states size and camera.
  void Begin() {
    ReadResult read;
    while ((read = Read(milliseconds(100))).status == ReadStatus::kTimeout) {
      if (options_.keep_waiting && !options_.keep_waiting()) {
        throw InputError(name_ + ": interrupted before the first image");
      }
    }
    if (read.status == ReadStatus::kEnd) {
      throw InputError(name_ + ": expected PGM images of 16 bits, found nothing");
    }
    first_ = std::move(read);
  }

  ReadResult Read(milliseconds timeout) override {
    if (first_) return *std::exchange(first_, std::nullopt);
    const Clock::time_point deadline = Clock::now() + timeout;
    while (!has_ended_) {
      if (IsImageComplete()) return TakeImage();
      const auto left = std::chrono::ceil<milliseconds>(deadline - Clock::now());
      switch (input_.Append(bytes_, BytesWanted(), std::max(left, milliseconds(0)), name_)) {
        case Descriptor::Outcome::kRead:
          break;
        case Descriptor::Outcome::kTimeout:
          return {.status = ReadStatus::kTimeout, .frame = {}};
        case Descriptor::Outcome::kEnd:
          End();
      }
    }
    return {.status = ReadStatus::kEnd, .frame = {}};
  }
  const Camera& camera() const override { return camera_; }
  bool is_live() const override { return is_live_; }
  std::optional<int64_t> frame_count() const override { return std::nullopt; }

 private:
  std::string Place() const { return name_ + ": image " + std::to_string(next_); }

  // Parses the header of the image that is coming, once it is there.
  bool IsHeaderComplete() {
    if (header_) return true;
    constexpr std::string_view kBlanks = " \t\n\v\f\r";  // a line's end behind an image
    const size_t blanks =
        std::string_view(reinterpret_cast<const char*>(bytes_.data()), bytes_.size())
            .find_first_not_of(kBlanks);
    bytes_.erase(bytes_.begin(), blanks == std::string_view::npos
                                     ? bytes_.end()
                                     : bytes_.begin() + static_cast<ptrdiff_t>(blanks));
    header_ =
        ParsePgmHeader({reinterpret_cast<const char*>(bytes_.data()), bytes_.size()}, Place());
    if (!header_ && bytes_.size() >= kLongestPgmHeader) {
      throw InputError(Place() + ": expected a PGM header of at most " +
                       std::to_string(kLongestPgmHeader) + " bytes");
    }
    if (header_) CheckHeader();
    return header_.has_value();
  }

  void CheckHeader() const {
    if (header_->bytes != 2) {
      throw InputError(Place() +
                       ": expected 16 bits a pixel, a brightest value above 255, found 8");
    }
    if (!size_ || *size_ == header_->size) return;
    throw InputError(Place() + ": expected " + SizeText(*size_) + " like the others, found " +
                     SizeText(header_->size));
  }

  bool IsImageComplete() {
    return IsHeaderComplete() && bytes_.size() >= header_->image_at + header_->ImageBytes();
  }

  // No more than up to the end of an image, once its header is known.
  size_t BytesWanted() const {
    constexpr size_t kStep = 256;  // bytes, by hand: a header with its comments
    return header_ ? header_->image_at + header_->ImageBytes() - bytes_.size() : kStep;
  }

  ReadResult TakeImage() {
    ReadResult result{.status = ReadStatus::kFrame, .frame = {}};
    try {
      const Remarks remarks = ParseRemarks(*header_);
      result.frame.camera = CameraOf(remarks);
      result.frame.time_s = TimeOf(remarks);
    } catch (const InputError& error) {
      throw InputError(Place() + ": " + error.what());
    }
    const NumberFormat format{.kind = NumberKind::kUnsigned,
                              .size = header_->bytes,
                              .is_swapped = std::endian::native == std::endian::little};
    const std::span image = std::span(bytes_).subspan(header_->image_at, header_->ImageBytes());
    result.frame.depth_mm = DepthsOf(format, image, 1.0);
    result.frame.index = next_++;
    bytes_.erase(bytes_.begin(),
                 bytes_.begin() + static_cast<ptrdiff_t>(header_->image_at + image.size()));
    header_.reset();
    return result;
  }

  // By option, else as the images say, else by a file beside them or the size of the first one.
  const Camera& CameraOf(const Remarks& remarks) {
    const ImageSize size = header_->size;
    if (!options_.camera && remarks.camera) {
      SourceOptions stated = options_;
      stated.camera = remarks.camera;
      camera_ = ChosenCamera(stated, size.width, size.height);
    } else if (!size_) {
      camera_ = FileCamera(name_, folder_, size, options_);
    }
    size_ = size;
    return camera_;
  }

  // As the images say, else when they arrive; of a file, 30 a second.
  double TimeOf(const Remarks& remarks) {
    constexpr double kFrameRate = 30.0;  // Hz, of the usual depth camera; by convention
    const Clock::time_point now = Clock::now();
    if (next_ == 0) {
      has_times_ = remarks.time_s.has_value();
      first_time_s_ = remarks.time_s.value_or(0.0);
      began_ = now;
    }
    if (has_times_ && !remarks.time_s) {
      throw InputError("expected a comment '# time_s SECONDS' like the first image's, found none");
    }
    if (has_times_) return clock_.TimeOf(*remarks.time_s - first_time_s_);
    if (!is_live_) return static_cast<double>(next_) / kFrameRate;
    return std::chrono::duration<double>(now - began_).count();
  }

  void End() {
    has_ended_ = true;
    if (bytes_.empty()) return;
    const std::string what = Place() + ": cut short";
    if (next_ == 0) throw InputError(what);
    if (options_.note) {
      options_.note(NoteKind::kWarning,
                    what + ": the " + std::to_string(next_) + " images before it are complete");
    }
  }

  std::string name_;
  Descriptor input_;
  std::filesystem::path folder_;
  bool is_live_;
  SourceOptions options_;
  std::optional<ReadResult> first_;  // read, but not delivered
  std::vector<uint8_t> bytes_;       // from the beginning of the next image
  std::optional<PgmHeader> header_;  // of it
  std::optional<ImageSize> size_;    // of all images
  Camera camera_;
  int64_t next_ = 0;  // number of the next image
  bool has_times_ = false, has_ended_ = false;
  double first_time_s_ = 0.0;
  Clock::time_point began_;
  SensorClock clock_;
};

// A file on standard input is opened anew, so that it can be read twice.
Descriptor OpenInput(const std::string& source, const std::string& name) {
  const Descriptor standard(STDIN_FILENO, false);
  const bool is_standard = source == kStandardInput;
  if (is_standard && standard.IsTerminal()) {
    throw InputError(name + ": expected PGM images of another program, found a terminal");
  }
  if (is_standard && !standard.IsRegularFile()) return {STDIN_FILENO, false};
  // Not waiting for a named pipe's writer, so that an interruption ends it.
  const int fd =
      open(is_standard ? "/dev/stdin" : source.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (fd < 0) throw InputError(name + ": cannot be read: " + std::strerror(errno));
  return {fd, true};
}

constexpr std::string_view kMagic = "P5";

}  // namespace

bool HoldsSeveralPgms(const std::filesystem::path& path) {
  if (LowerCaseExtension(path) != ".pgm") return false;
  std::ifstream file = OpenFile(path);
  std::string text(kLongestPgmHeader, ' ');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<size_t>(file.gcount()));
  try {
    const auto header = ParsePgmHeader(text, path.string());
    if (!header) return false;
    file.clear();
    file.seekg(static_cast<std::streamoff>(header->image_at + header->ImageBytes()));
    std::string next;
    return static_cast<bool>(file >> std::setw(kMagic.size()) >> next) && next == kMagic;
  } catch (const InputError&) {  // reported when it is opened as a still
    return false;
  }
}

bool IsStream(const std::string& source) {
  std::error_code unknown;
  return source == kStandardInput || std::filesystem::is_fifo(source, unknown);
}

std::unique_ptr<FrameSource> OpenImageStream(const std::string& source,
                                             const SourceOptions& options) {
  const std::string name = source == kStandardInput ? "standard input" : source;
  const std::filesystem::path folder =
      IsStream(source) ? "" : std::filesystem::absolute(source).lexically_normal().parent_path();
  auto stream = std::make_unique<ImageStream>(name, OpenInput(source, name), folder, options);
  stream->Begin();
  return stream;
}

}  // namespace ossa::depth
