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
  /// One layer: outputs = rectified(weights x inputs + bias).
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
/// The value of an IEEE half-precision number.
inline float OfHalf(uint16_t half) {
  return std::bit_cast<float>(static_cast<uint32_t>(half) << 16U);
}

/// A layer's weights in bytes: of each input's the largest is 127.
struct WeightBytes {
  Eigen::Matrix<int8_t, Eigen::Dynamic, Eigen::Dynamic> of;  // output x input
  Eigen::VectorXf step;                                      // of each input: a byte's worth

  Eigen::MatrixXf Weights() const;
};
/// Of weights that were bytes once, the same bytes.
WeightBytes BytesOf(const Eigen::MatrixXf& weight);

/// How weights are written: the upper halves of their floats (what is learned has no lower ones),
/// or bytes.
enum class WeightForm { kHalves, kBytes };

/// Into a payload. How many units there are is not written.
void PutNetwork(PayloadWriter& out, const RectifiedNetwork& network,
                WeightForm form = WeightForm::kHalves);
/// `sizes`: inputs, units of each hidden layer, outputs. Throws InputError where there are not so
/// many or some number is immodest.
RectifiedNetwork GetNetwork(PayloadReader& in, const std::vector<Eigen::Index>& sizes,
                            WeightForm form = WeightForm::kHalves);

/// How many units a layer has, of which no file may have absurdly many.
Eigen::Index GetUnits(PayloadReader& in);

}  // namespace ossa::recon
