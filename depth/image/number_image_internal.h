#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "depth/image/depth_png.h"
#include "depth/image/number_format.h"

namespace ossa::depth {

/// An image of numbers as a file holds it: row-major, height × width × channels.
struct NumberImage {
  ImageSize size;
  NumberFormat format;
  int channels = 1;
  std::vector<uint8_t> numbers;  // empty if only the header was read
};

/// What of a file is read.
enum class ReadPart { kHeader, kAll };

/// Netpbm's binary greys (P5), high byte first; low byte first in a dump of libfreenect's fakenect,
/// by its name, d-SECONDS-TICKS.pgm. All throw InputError that names the file.
NumberImage ReadPgm(const std::filesystem::path& path, ReadPart part);
/// TIFF in rows, of one image: integers and floats, in any compression of libtiff.
NumberImage ReadTiff(const std::filesystem::path& path, ReadPart part);

class TiffFile;
/// The images of a TIFF file of several pages: those of the first one's size and format.
class TiffPages {
 public:
  /// Throws InputError for what is no TIFF file.
  explicit TiffPages(const std::filesystem::path& path);
  ~TiffPages();
  const NumberImage& first() const { return first_; }  // without numbers
  int count() const { return count_; }
  /// Goes to the first, then to each next one; false behind the last.
  bool Next();
  /// The image there. Throws InputError if it is damaged.
  NumberImage Read();

 private:
  std::unique_ptr<TiffFile> file_;
  NumberImage first_;
  int count_ = 0, next_ = 0;
};

/// The depths of one channel of 16 bits or more; floats by their range (GuessUnit_mm).
Image<uint16_t> ToDepth(const NumberImage& image);
/// NumPy's .npy of an array of two dimensions longer than 1.
NumberImage ReadNpy(const std::filesystem::path& path, ReadPart part);

/// The header of an .npy file, versions 1 to 3.
struct NpyHeader {
  NumberFormat format;
  bool is_fortran = false;    // the first dimension changes fastest
  std::vector<size_t> shape;  // as NumPy prints it
  size_t data_offset = 0;     // bytes before the numbers
};

/// "300x240x320".
std::string ShapeText(std::span<const size_t> shape);

/// The most bytes of a header, by hand: NumPy's have 128, and only structures, which are refused,
/// need many. Of each file of a folder so much is read before its image is.
inline constexpr size_t kLongestNpyHeader = 4096;

/// Parses the first bytes of a file. Throws InputError, `prefix` first, for other files, and for
/// arrays of anything but integers and floats.
NpyHeader ParseNpyHeader(std::span<const uint8_t> bytes, const std::string& prefix);

}  // namespace ossa::depth
