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

/// Storage of weights: the upper halves of their floats (training sets the lower ones to 0), or
/// bytes.
enum class WeightForm { kHalves, kBytes };

/// Writes a perceptron into a payload, except for its layer sizes.
void PutPerceptron(PayloadWriter& out, const Perceptron& perceptron,
                   WeightForm form = WeightForm::kHalves);
/// `sizes`: inputs, units of each hidden layer, outputs. Throws InputError for missing numbers or
/// numbers beyond a million.
Perceptron GetPerceptron(PayloadReader& in, const std::vector<Eigen::Index>& sizes,
                         WeightForm form = WeightForm::kHalves);

/// Reads the number of units of a layer. Throws InputError for zero or an implausible number.
Eigen::Index GetUnits(PayloadReader& in);

/// Writes numbers as upper halves of floats; reading throws InputError that names the field for
/// missing numbers or numbers beyond a million.
void PutHalves(PayloadWriter& out, std::span<const float> numbers);
RowMatrix GetHalves(PayloadReader& in, std::string_view field, Eigen::Index rows,
                    Eigen::Index columns);
Eigen::VectorXf GetFloats(PayloadReader& in, std::string_view field, Eigen::Index count);
/// Whether all numbers are within a million of 0.
bool AreModest(const RowMatrix& numbers);

/// The upper half of a float, rounded; and the float that it represents.
uint16_t RoundToHalf(float number);
inline float ExpandHalf(uint16_t half) {
  return std::bit_cast<float>(static_cast<uint32_t>(half) << 16U);
}

/// A layer's weights as bytes, scaled per input so that the largest is 127.
struct WeightBytes {
  Eigen::Matrix<int8_t, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> bytes;  // input × output
  Eigen::VectorXf step;  // scale of each input's weights

  RowMatrix ToWeights() const;
};
/// Quantises weights; already quantised ones give the same bytes.
WeightBytes RoundToBytes(const RowMatrix& weight);

}  // namespace ossa
