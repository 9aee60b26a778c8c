// Refinement cascade (.ossarefine): any payload is a value or an InputError.
#include <cstdint>

#include "recon/refine/bone_estimation.h"
#include "recon/refine/refinement_cascade.h"
#include "tests/fuzz/outcome.h"
#include "tests/fuzz/seeds.h"

namespace {

namespace recon = ossa::recon;
using recon::RefinementCascade;

ossa::Perceptron Plain(Eigen::Index inputs, Eigen::Index outputs) {
  return {Eigen::RowVectorXf::Zero(inputs),
          Eigen::RowVectorXf::Ones(inputs),
          {{ossa::RowMatrix::Ones(inputs, outputs), Eigen::RowVectorXf::Zero(outputs)}}};
}

}  // namespace

std::vector<std::string> ossa::fuzz::Seeds() {
  RefinementCascade cascade;
  cascade.people = cascade.measured = 1;
  cascade.stages.emplace_back().fill(Plain(recon::kStageFeatures, 3));
  cascade.bones = Plain(recon::kBoneFeatures, recon::kEstimatedBones.size());
  cascade.bone_conditioned.emplace_back().fill(Plain(recon::kBoneConditionedFeatures, 3));
  const std::string path = ScratchPath("cascade");
  cascade.Save(path);
  return {TakePayload(path)};
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  ossa::fuzz::ExpectValueOrOneLine([&] {
    const auto cascade =
        RefinementCascade::FromBytes(std::as_bytes(std::span(data, size)), "x.ossarefine");
    const auto run = [](const std::vector<recon::RefinementStage>& stages, Eigen::Index inputs) {
      for (const recon::RefinementStage& stage : stages) {
        for (const ossa::Perceptron& network : stage) {
          if (!network.Run(ossa::RowMatrix::Zero(1, inputs)).allFinite()) abort();
        }
      }
    };
    run(cascade.stages, recon::kStageFeatures);
    run(cascade.bone_conditioned, recon::kBoneConditionedFeatures);
    if (!cascade.bones.empty() &&
        !cascade.bones.Run(ossa::RowMatrix::Zero(1, recon::kBoneFeatures)).allFinite()) {
      abort();
    }
  });
  return 0;
}
