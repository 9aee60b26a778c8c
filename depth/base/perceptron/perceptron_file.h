#pragma once
#include <Eigen/Core>
#include <bit>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "depth/base/perceptron/perceptron.h"

namespace ossa {

class PayloadReader;
class PayloadWriter;

/// How weights are written: the upper halves of their floats (training leaves the lower ones 0), or
/// bytes.
enum class WeightForm { kHalves, kBytes };

/// Writes a perceptron into a payload, but not how many units each layer has.
void PutPerceptron(PayloadWriter& out, const Perceptron& perceptron,
                   WeightForm form = WeightForm::kHalves);
/// `sizes`: inputs, units of each hidden layer, outputs. Throws InputError where there are not so
/// many numbers or one of them is not within a million of 0.
Perceptron GetPerceptron(PayloadReader& in, const std::vector<Eigen::Index>& sizes,
                         WeightForm form = WeightForm::kHalves);

/// Reads how many units a layer has. Throws InputError for none, or for absurdly many.
Eigen::Index GetUnits(PayloadReader& in);

/// Numbers as upper halves of floats, and as floats; reads throw InputError that names the field
/// where there are not so many or one of them is not within a million of 0.
void PutHalves(PayloadWriter& out, std::span<const float> numbers);
RowMatrix GetHalves(PayloadReader& in, std::string_view field, Eigen::Index rows,
                    Eigen::Index columns);
Eigen::VectorXf GetFloats(PayloadReader& in, std::string_view field, Eigen::Index count);
/// Whether all numbers are within a million of 0.
bool AreModest(const RowMatrix& numbers);

/// The upper half of a float, rounded, and the float that it stands for.
uint16_t RoundToHalf(float number);
inline float ExpandHalf(uint16_t half) {
  return std::bit_cast<float>(static_cast<uint32_t>(half) << 16U);
}

/// A layer's weights in bytes: of each input's the largest is 127.
struct WeightBytes {
  Eigen::Matrix<int8_t, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> bytes;  // input × output
  Eigen::VectorXf step;  // of each input: what a byte's 1 is worth

  RowMatrix ToWeights() const;
};
/// Of weights that were bytes once, the same bytes.
WeightBytes RoundToBytes(const RowMatrix& weight);

}  // namespace ossa
