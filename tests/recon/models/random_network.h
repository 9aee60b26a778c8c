#pragma once

#include "recon/models/network_runner.h"

namespace ossa::recon::test {

// Of random weights, as files have them.
inline RectifiedNetwork RandomNetwork(int hidden, Eigen::Index units, Eigen::Index inputs,
                                      Eigen::Index outputs = 3) {
  RectifiedNetwork network;
  network.input_mean = Eigen::VectorXf::Random(inputs);
  network.input_scale = 3.0F * Eigen::VectorXf::Random(inputs).cwiseAbs();
  for (int l = 0; l < hidden; ++l, inputs = units) {
    network.layers.push_back(
        {Eigen::MatrixXf::Random(units, inputs), Eigen::VectorXf::Random(units)});
  }
  network.layers.push_back(
      {Eigen::MatrixXf::Random(outputs, inputs), Eigen::VectorXf::Random(outputs)});
  for (RectifiedNetwork::Layer& layer : network.layers) {
    layer.weight = BytesOf(layer.weight).Weights();
  }
  return network;
}

}  // namespace ossa::recon::test
