#pragma once
#include <Eigen/Core>
#include <bit>
#include <cstdint>
#include <vector>

namespace ossa {
class PayloadReader;
class PayloadWriter;
}  // namespace ossa

namespace ossa::recon {

/// inputs -> rectified units, one layer or more -> outputs. The inputs are normalised first.
struct RectifiedNetwork {
  struct Layer {
    Eigen::MatrixXf weight;  // output x input
    Eigen::VectorXf bias;
  };

  Eigen::VectorXf input_mean, input_scale;  // scale: 1 / standard deviation
  std::vector<Layer> layers;                // the last one's outputs are not rectified

  /// Without layers there is nothing to say.
  bool empty() const { return layers.empty(); }
  Eigen::VectorXf Run(const Eigen::Ref<const Eigen::VectorXf>& input) const;
  /// What the first layer gets of an input.
  Eigen::VectorXf Normalised(const Eigen::Ref<const Eigen::VectorXf>& input) const;
};

/// The upper half of a float, rounded, and the float that it stands for.
uint16_t HalfOf(float number);
inline float OfHalf(uint16_t half) {
  return std::bit_cast<float>(static_cast<uint32_t>(half) << 16U);
}

/// Into a payload; of the weights, the upper halves of their floats: the lower halves say nothing.
/// How many units there are is not written.
void PutNetwork(PayloadWriter& out, const RectifiedNetwork& network);
/// `sizes`: inputs, units of each hidden layer, outputs. Throws InputError where there are not so
/// many or some number is immodest.
RectifiedNetwork GetNetwork(PayloadReader& in, const std::vector<Eigen::Index>& sizes);

/// How many units a layer has, of which no file may have absurdly many.
Eigen::Index GetUnits(PayloadReader& in);

}  // namespace ossa::recon
