// ossa_mkv_reader FILE.mkv: writes the depth images of an Azure Kinect or Femto recording to
// standard output. k4arecorder's format: a video track titled DEPTH of uncompressed 16-bit grey,
// millimetres; the camera's calibration is attached as JSON; colour, infrared and inertial tracks
// are ignored. Any lossless codec for 16-bit grey works, too.
extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
}

#include <array>
#include <bit>
#include <cstring>
#include <fstream>
#include <memory>
#include <optional>
#include <string>

#include "depth/base/error.h"
#include "depth/sensor/readers/k4a_calibration.h"
#include "depth/sensor/readers/matroska_length.h"
#include "depth/sensor/readers/reader_pipe_internal.h"

namespace ossa::depth {
namespace {

struct Free {
  void operator()(AVFormatContext* file) const { avformat_close_input(&file); }
  void operator()(AVCodecContext* decoder) const { avcodec_free_context(&decoder); }
  void operator()(AVPacket* packet) const { av_packet_free(&packet); }
  void operator()(AVFrame* frame) const { av_frame_free(&frame); }
};
template <typename T>
using Owned = std::unique_ptr<T, Free>;

std::string ErrorText(int error) {
  std::array<char, AV_ERROR_MAX_STRING_SIZE> text{};
  av_strerror(error, text.data(), text.size());
  return text.data();
}

Owned<AVFormatContext> Open(const std::string& path) {
  AVFormatContext* file = nullptr;
  const AVInputFormat* matroska = av_find_input_format("matroska");
  const int error = avformat_open_input(&file, ("file:" + path).c_str(), matroska, nullptr);
  if (error < 0) throw InputError("expected a Matroska recording, found: " + ErrorText(error));
  return Owned<AVFormatContext>(file);
}

std::string Tag(const AVDictionary* tags, const char* name) {
  const AVDictionaryEntry* entry = av_dict_get(tags, name, nullptr, 0);
  return entry != nullptr ? entry->value : "";
}

AVStream& FindDepthTrack(AVFormatContext& file) {
  for (unsigned i = 0; i < file.nb_streams; ++i) {
    AVStream& stream = *file.streams[i];
    const bool is_depth =
        Tag(stream.metadata, "title") == "DEPTH" || !Tag(stream.metadata, "K4A_DEPTH_MODE").empty();
    if (is_depth && stream.codecpar->codec_type == AVMEDIA_TYPE_VIDEO) return stream;
  }
  throw InputError("expected a video track titled DEPTH, as k4arecorder writes it, found none");
}

std::optional<std::string> AttachedCalibration(const AVFormatContext& file) {
  for (unsigned i = 0; i < file.nb_streams; ++i) {
    const AVStream& stream = *file.streams[i];
    const bool is_one = stream.codecpar->codec_type == AVMEDIA_TYPE_ATTACHMENT &&
                        (Tag(stream.metadata, "filename") == "calibration.json" ||
                         !Tag(stream.metadata, "K4A_CALIBRATION_FILE").empty());
    if (!is_one) continue;
    return std::string(reinterpret_cast<const char*>(stream.codecpar->extradata),
                       static_cast<size_t>(stream.codecpar->extradata_size));
  }
  return std::nullopt;
}

Owned<AVCodecContext> OpenDecoder(const AVStream& track) {
  const AVCodec* codec = avcodec_find_decoder(track.codecpar->codec_id);
  Owned<AVCodecContext> decoder(codec != nullptr ? avcodec_alloc_context3(codec) : nullptr);
  if (!decoder || avcodec_parameters_to_context(decoder.get(), track.codecpar) < 0 ||
      avcodec_open2(decoder.get(), codec, nullptr) < 0) {
    throw InputError("depth track: its codec cannot be read: " +
                     std::string(avcodec_get_name(track.codecpar->codec_id)));
  }
  return decoder;
}

class DepthTrack {
 public:
  DepthTrack(AVFormatContext& file, AVStream& track)
      : track_(track), width_(track.codecpar->width), height_(track.codecpar->height) {
    if (width_ < 1 || height_ < 1 || width_ > kLargestImageSide || height_ > kLargestImageSide) {
      throw InputError("depth track: expected a size, found " + std::to_string(width_) + "x" +
                       std::to_string(height_));
    }
    ReaderHello hello;
    hello.is_unit_stated = true;
    hello.camera.width = width_;
    hello.camera.height = height_;
    if (const auto calibration = AttachedCalibration(file)) TakeCalibration(*calibration, hello);
    SendHello(hello);
  }

  // Azure's frames are strongly distorted: 30 pixels in the corners of the narrow view.
  void Give(const AVFrame& frame) const {
    if (frame.width != width_ || frame.height != height_) {
      throw InputError("depth track: a frame of another size");
    }
    const bool big = frame.format == AV_PIX_FMT_GRAY16BE;
    if (!big && frame.format != AV_PIX_FMT_GRAY16LE) {
      throw InputError("depth track: expected greys of 16 bits");
    }
    std::vector<uint16_t> depth_mm(static_cast<size_t>(width_) * static_cast<size_t>(height_));
    for (int v = 0; v < height_; ++v) {
      const uint8_t* row = frame.data[0] + static_cast<ptrdiff_t>(v) * frame.linesize[0];
      uint16_t* to = depth_mm.data() + static_cast<ptrdiff_t>(v) * width_;
      std::memcpy(to, row, sizeof(uint16_t) * static_cast<size_t>(width_));
    }
    if (big != (std::endian::native == std::endian::big)) {
      for (uint16_t& d : depth_mm) d = static_cast<uint16_t>(d << 8 | d >> 8);
    }
    if (!undistortion_.empty()) depth_mm = Undistorted(depth_mm, undistortion_);
    const auto ticks = static_cast<double>(frame.best_effort_timestamp);
    SendFrame({width_, height_, ticks * av_q2d(track_.time_base)}, depth_mm);
  }

 private:
  // An invalid calibration prevents undistortion, not reading.
  void TakeCalibration(const std::string& text, ReaderHello& hello) {
    try {
      const LensCamera lens = ReadK4aCalibration(text, width_, height_);
      undistortion_ = UndistortionMap(lens);
      hello.camera = lens.pinhole;
      hello.is_camera_stated = true;
    } catch (const InputError& error) {
      SendText(ReaderKind::kNote, error.what());
    }
  }

  const AVStream& track_;
  int width_, height_;
  std::vector<int32_t> undistortion_;
};

void Read(const std::string& path) {
  av_log_set_level(AV_LOG_QUIET);
  const auto file = Open(path);
  std::ifstream bytes(path, std::ios::binary);
  if (const auto warning = CheckForCut(bytes)) SendText(ReaderKind::kWarning, *warning);
  AVStream& track = FindDepthTrack(*file);
  for (unsigned i = 0; i < file->nb_streams; ++i) {
    if (file->streams[i] != &track) file->streams[i]->discard = AVDISCARD_ALL;
  }
  const auto decoder = OpenDecoder(track);
  const DepthTrack depth(*file, track);
  const Owned<AVPacket> packet(av_packet_alloc());
  const Owned<AVFrame> frame(av_frame_alloc());
  for (;;) {
    const int got = av_read_frame(file.get(), packet.get());
    if (got < 0 && got != AVERROR_EOF) throw InputError("cut short: " + ErrorText(got));
    const bool is_cut = got >= 0 && (packet->flags & AV_PKT_FLAG_CORRUPT) != 0;
    if (is_cut || (got >= 0 && packet->stream_index != track.index)) {
      av_packet_unref(packet.get());
      continue;
    }
    if (avcodec_send_packet(decoder.get(), got < 0 ? nullptr : packet.get()) < 0) {
      throw InputError("depth track: a frame is damaged");
    }
    av_packet_unref(packet.get());
    while (avcodec_receive_frame(decoder.get(), frame.get()) >= 0) depth.Give(*frame);
    if (got < 0) return;
  }
}

}  // namespace
}  // namespace ossa::depth

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  ossa::depth::RunReader([&] { ossa::depth::Read(argv[1]); });
}
