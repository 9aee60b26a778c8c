#include "depth/sensor/depth_census.h"

#include <algorithm>
#include <array>
#include <bitset>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <span>
#include <string>

#include "depth/sensor/depth_coding.h"

// Constants: chosen on rendered clips of every view and noise and on the real frames of Kinect v1,
// Xtion and PrimeSense of depth_units_test.cpp, none of which may be suspected: there at most 48 %
// of the numbers are multiples of 4 or 10, 15 % of the steps are multiples of 8, and 1 % are within
// 0.53 m.
namespace ossa::depth {
namespace {

constexpr int64_t kEnoughReadings = 400;

// Range in which people are tracked, with a margin.
constexpr double kNearest_mm = 300.0, kFarthest_mm = 12000.0;

bool MayBeDistance(double mm) { return mm >= kNearest_mm && mm <= kFarthest_mm; }

using Counts = std::vector<int64_t>;  // histogram of 65536 values

// Statistics of the non-zero values.
struct Spread {
  int64_t readings = 0;
  int64_t zeros = 0;
  int distinct = 0;
  int percent_1 = 0, percent_5 = 0, percent_25 = 0, median = 0, percent_95 = 0, largest = 0;
};

int Percentile(const Counts& count, int64_t readings, double share) {
  int64_t place = static_cast<int64_t>(share * static_cast<double>(readings - 1));
  for (int number = 1; number < 65536; ++number) {
    place -= count[static_cast<size_t>(number)];
    if (place < 0) return number;
  }
  return 0;
}

Spread MeasureSpread(const Counts& count) {
  Spread spread;
  spread.zeros = count[0];
  for (int number = 1; number < 65536; ++number) {
    const int64_t here = count[static_cast<size_t>(number)];
    spread.readings += here;
    spread.distinct += here > 0 ? 1 : 0;
    if (here > 0) spread.largest = number;
  }
  spread.percent_1 = Percentile(count, spread.readings, 0.01);
  spread.percent_5 = Percentile(count, spread.readings, 0.05);
  spread.percent_25 = Percentile(count, spread.readings, 0.25);
  spread.median = Percentile(count, spread.readings, 0.5);
  spread.percent_95 = Percentile(count, spread.readings, 0.95);
  return spread;
}

// Share of the readings that satisfy a predicate.
template <typename Holds>
double Share(const Counts& count, const Spread& spread, const Holds& holds) {
  int64_t sum = 0;
  for (int number = 1; number < 65536; ++number) {
    if (holds(number)) sum += count[static_cast<size_t>(number)];
  }
  return static_cast<double>(sum) / static_cast<double>(spread.readings);
}

std::string Metres(double mm) {
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), mm * 1e-3,
                                 std::chars_format::general, 2);
  return std::string(digits.data(), end.ptr) + " m";
}

// High bytes of distances are small; if they are the low byte of every value, bytes are exchanged.
bool AreBytesExchanged(const Counts& count, const Spread& spread) {
  constexpr int kMostHighByte = static_cast<int>(kFarthest_mm) / 256;
  constexpr size_t kManyBytes = 16;
  Counts exchanged(count.size(), 0);
  std::bitset<256> low_bytes;
  for (size_t number = 1; number < count.size(); ++number) {
    exchanged[(number & 0xFF) << 8 | number >> 8] = count[number];
    if (count[number] > 0) low_bytes.set(number >> 8);
  }
  const auto fits = [](int number) { return (number & 0xFF) <= kMostHighByte; };
  return Share(count, spread, fits) > 0.995 && low_bytes.count() >= kManyBytes &&
         MayBeDistance(MeasureSpread(exchanged).median);
}

// Shifts end at 1090, at infinity; 2047 means no reading. If every pixel has a reading, they cannot
// be distinguished from millimetres of a very near wall, in front of which nobody could stand.
bool AreShifts(const Counts& count, const Spread& spread) {
  constexpr int kNoShift = 2047, kInfinite = 1091, kOfARoom = 880;  // 1.6 m
  const auto between = [](int number) { return number >= kInfinite && number < kNoShift; };
  if (Share(count, spread, between) > 0.002) return false;
  if (spread.largest == kNoShift) {
    return count[kNoShift] * 500 > spread.readings && spread.zeros * 10 < count[kNoShift];
  }
  const int64_t all = spread.readings + spread.zeros;
  return spread.largest < kInfinite && spread.percent_1 > kNearest_mm &&
         spread.percent_95 > kOfARoom && spread.zeros * 10 < all;
}

std::optional<DepthSuspicion> JudgeFormat(const Counts& count, const Spread& spread) {
  constexpr int kInvertedFrom = 65535 - static_cast<int>(kFarthest_mm);
  if (AreShifts(count, spread)) {
    return DepthSuspicion{"a Kinect v1's raw shifts of 11 bits", "--depth-format disparity"};
  }
  if (spread.percent_5 > kInvertedFrom) {
    return DepthSuspicion{"distances taken from 65535, so that the nearest are the largest",
                          "--depth-format inverted"};
  }
  if (AreBytesExchanged(count, spread)) {
    return DepthSuspicion{"distances whose two bytes are exchanged", "--depth-format swapped"};
  }
  return std::nullopt;
}

// Share of the distinct values that satisfy a predicate: a frontal wall has a single value.
template <typename Holds>
double ComputeNumberShare(const Counts& count, const Spread& spread, const Holds& holds) {
  int sum = 0;
  for (int number = 1; number < 65536; ++number) {
    if (count[static_cast<size_t>(number)] > 0 && holds(number)) ++sum;
  }
  return static_cast<double>(sum) / spread.distinct;
}

// Share of the readings with one of the three most frequent remainders modulo eight: player bits
// are 0 and one value per person, while a sensor's readings have all eight remainders.
double ComputeThreeRemainderShare(const Counts& count, const Spread& spread) {
  std::array<int64_t, 8> of{};
  for (size_t number = 1; number < count.size(); ++number) of[number % 8] += count[number];
  std::sort(of.rbegin(), of.rend());
  return static_cast<double>(of[0] + of[1] + of[2]) / static_cast<double>(spread.readings);
}

struct Unit {
  int of_mm;  // units per millimetre
  const char* looks;
};

// Detects whole millimetres times a factor: sensor readings have all remainders. Values clipped to
// 16 bits may have any. With a factor of eight the low bits may hold player indices: then
// differences between pixels have no remainder.
std::optional<DepthSuspicion> JudgeMultiples(const Counts& count, const Spread& spread,
                                             double share_of_steps_of_8) {
  constexpr std::array<Unit, 4> kUnits = {{{10, "tenths of a millimetre"},
                                           {8, "Kinect SDK depths with player bits, mm << 3"},
                                           {5, "fifths of a millimetre, as TUM's"},
                                           {4, "quarters of a millimetre"}}};
  constexpr int kManyNumbers = 16;
  constexpr double kNearlyAll = 0.8;  // minimum share of the readings
  constexpr double kAll = 0.99;
  constexpr double kMost = 0.6;  // of distinct values: half of fours are eights by chance
  if (spread.distinct < kManyNumbers) return std::nullopt;
  const bool of_4 = Share(count, spread, [](int number) { return number % 4 == 0; }) > kNearlyAll;
  const bool has_players =
      share_of_steps_of_8 > 0.95 || (!of_4 && ComputeThreeRemainderShare(count, spread) > kAll);
  for (const Unit& unit : kUnits) {
    const auto is_multiple = [&](int number) { return number % unit.of_mm == 0; };
    const bool all = (Share(count, spread, is_multiple) > kNearlyAll &&
                      ComputeNumberShare(count, spread, is_multiple) > kMost) ||
                     (unit.of_mm == 8 && has_players);
    // A sensor that rounds to centimetres does not give tenths of millimetres; people are within 5
    // m.
    const double least_mm = unit.of_mm == 10 ? 500.0 : kNearest_mm;
    const double median_mm = static_cast<double>(spread.median) / unit.of_mm;
    if (!all || median_mm < least_mm || median_mm > kFarthest_mm) continue;
    return DepthSuspicion{std::string(unit.looks) +
                              ": as millimetres half of them would lie beyond " +
                              Metres(spread.median),
                          "--depth-scale " + std::to_string(unit.of_mm * 1000)};
  }
  return std::nullopt;
}

std::optional<DepthSuspicion> JudgeRange(const Spread& spread) {
  constexpr int kHeadAlone_mm = 640;    // nearer, only a head is in view
  constexpr int kNearRoom_mm = 1000;    // no room is this small
  constexpr int kNearerThanMost = 400;  // few cameras measure here
  // No camera sees much of a room here; of the table before an Azure Kinect, 6 % of an image.
  constexpr int kBlind_mm = 120;
  constexpr int kFarRoom_mm = 20000;  // beyond the range of stereo cameras in halls
  if (spread.percent_95 < kHeadAlone_mm ||
      (spread.percent_95 < kNearRoom_mm && spread.percent_5 < kNearerThanMost)) {
    return DepthSuspicion{"centimetres: as millimetres nearly all of them would lie within " +
                              Metres(spread.percent_95),
                          "--depth-scale 100"};
  }
  if (spread.percent_25 < kBlind_mm) {
    return DepthSuspicion{
        "no distances: a quarter would lie within " + Metres(spread.percent_25) +
            ", where people are too near for any depth camera (were they inverted or stretched?)",
        ""};
  }
  // If a renderer writes one far value for the background, objects in front of it are near.
  if (spread.percent_5 > kFarthest_mm && spread.median > kFarRoom_mm) {
    return DepthSuspicion{
        "distances stretched to 16 bits: as millimetres half of them would lie "
        "beyond " +
            Metres(spread.median) +
            "; --depth-scale reads them: 65535 / FARTHEST metres, of a Kinect v2's 4.5 m 14563",
        ""};
  }
  return std::nullopt;
}

}  // namespace

void DepthCensus::Add(const DepthView& image) {
  // In eighths of a millimetre, by hand: 50 mm. Steps from an object to the wall behind it have few
  // values, which may all be multiples of 8 by chance.
  constexpr int kOnOneSurface = 400;
  const auto reading = [&](int u, int v) {
    const uint16_t number = image.at(u, v);
    return number == kSaturatedDepth ? 0 : int{number};
  };
  for (int v = 0; v < image.height; ++v) {
    for (int u = 0; u < image.width; ++u) {
      const int here = reading(u, v);
      ++count_[static_cast<size_t>(here)];
      const int before = u > 0 ? reading(u - 1, v) : 0;
      const int step = std::abs(here - before);
      if (here == 0 || before == 0 || step == 0 || step > kOnOneSurface) continue;
      ++steps_;
      steps_of_8_ += step % 8 == 0 ? 1 : 0;
    }
  }
  bend_.Add(image);
  bulge_.Add(image);
  bulge_of_centimetres_.Add(image);
}

bool DepthCensus::IsEnough() const {
  return MeasureSpread(count_).readings >= kEnoughReadings && bulge_.IsEnough();
}

std::optional<DepthSuspicion> DepthCensus::Judge() const {
  constexpr int64_t kEnoughSteps = 300;
  constexpr int kFewNumbers = 10;  // a wall, or an empty image
  const Spread spread = MeasureSpread(count_);
  if (spread.readings < kEnoughReadings || spread.distinct < kFewNumbers) return std::nullopt;
  if (auto found = JudgeFormat(count_, spread)) return found;
  const double share =
      steps_ < kEnoughSteps ? 0.0 : static_cast<double>(steps_of_8_) / static_cast<double>(steps_);
  if (auto found = JudgeMultiples(count_, spread, share)) return found;
  const DepthSuspicion inverted{
      "distances taken from some largest one, so that the nearest are the largest: "
      "floors, walls or bodies bend the wrong way; where FROM is the number that stands for 0 mm",
      "--depth-format inverted:FROM"};
  const auto range = JudgeRange(spread);
  const bool centimetres = range && !range->option.empty();
  // Inverted values of a person cut out, with the farthest point at 0, are as small as centimetres.
  if (centimetres && bulge_of_centimetres_.IsRound()) return range;
  // When a person enters the image, an arm's edge appears first, which may look hollow.
  if (bulge_.IsHollow() && !bend_.IsNotInverted()) return inverted;
  if (centimetres) return range;
  return bend_.IsInverted() && !bulge_.IsRound() ? inverted : range;
}

std::optional<double> DepthCensus::FindFarMedian_m() const {
  // By hand: halves and fifths of a room of 4 m with a person in it; of a hall the floor is nearer.
  constexpr int kFarPart_mm = 3000, kFarMedian_mm = 7000;
  constexpr double kMetresPerMillimetre = 1e-3;
  const Spread spread = MeasureSpread(count_);
  const bool is_far = spread.readings >= kEnoughReadings && spread.percent_5 > kFarPart_mm &&
                      spread.median > kFarMedian_mm;
  return is_far ? std::optional(kMetresPerMillimetre * spread.median) : std::nullopt;
}

}  // namespace ossa::depth
