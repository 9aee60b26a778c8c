#include "tests/robustness/samples.h"

#include <zlib.h>

#include <fstream>
#include <sstream>

#include "depth/image/depth_png.h"
#include "depth/sensor/oni_recorder.h"
#include "forest/forest.h"
#include "recon/database/posture_database.h"
#include "recon/files/skeleton_io.h"
#include "recon/files/skeleton_jsonl.h"
#include "recon/fit/surface_fit.h"
#include "recon/models/learned_models.h"
#include "recon/models/posture_prior.h"
#include "recon/refine/refinement_cascade.h"
#include "tests/recon/files/tar_bytes.h"
#include "tests/recon/files/zip_bytes.h"
#include "tests/recon/synthetic_motion.h"
#include "tests/robustness/recordings.h"
#include "tests/support/depth_examples.h"
#include "tests/support/places.h"
#include "tests/support/temporary_folder.h"
#include "tools/synth/shard_internal.h"

namespace ossa::test {
namespace {

namespace fs = std::filesystem;

std::string BytesOf(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// What `save` writes to a file of that name.
template <typename Save>
std::string Saved(const std::string& name, const Save& save) {
  const TemporaryFolder folder;
  save(folder / name);
  return BytesOf(folder / name);
}

// What was read is what is written again.
template <typename Model>
DamageSample SampleOf(const std::string& name, const Model& model) {
  return {name, Saved(name, [&](const fs::path& path) { model.Save(path); }),
          [name](const fs::path& path) {
            const Model read = Model::Load(path);
            return Reading{Saved(name, [&](const fs::path& again) { read.Save(again); })};
          }};
}

DamageSample Forest() {
  forest::Tree tree;
  tree.nodes.resize(3);
  tree.nodes[0].left = 1;
  tree.nodes[0].threshold_mm = 5;
  tree.nodes[1].left = ~0;
  tree.nodes[2].left = ~1;
  tree.entry_begin = {0, 1, 2};
  tree.entries = {static_cast<uint16_t>(100 << 9 | 1), static_cast<uint16_t>(90 << 9 | 2)};
  tree.votes.resize(1);
  forest::ForestData data;
  data.class_names = {"background", "a", "b"};
  data.context_names = {"any"};
  data.context_prior = {1.0F};
  data.trees = {tree};
  data.targets.emplace_back();
  data.targets[0].name = "Head";
  data.targets[0].classes = {1, 2};
  data.manifest = "{}";
  const auto save = [](const forest::ForestModel& model) {
    return Saved("x.ossa", [&](const fs::path& path) { forest::WriteForestModel(path, model); });
  };
  return {"x.ossa", save(forest::ForestModel(data)),
          [save](const fs::path& path) { return Reading{save(forest::ReadForestModel(path))}; }};
}

DamageSample Database() {
  std::vector<recon::PostureClip> clips(1);
  clips[0].name = "two";
  clips[0].postures = {recon::test::Gesture(0.2, 0.2, 0.1), recon::test::Gesture(1.5, 1.5, 0.1)};
  return SampleOf("x.ossadb", recon::PostureDatabase::Build(clips, {}));
}

DamageSample Learned() {
  recon::LearnedModels models;
  models.pair_count = 2;
  const auto features =
      static_cast<Eigen::Index>(recon::JointFeature(recon::Posture(), size_t{3}).size());
  Eigen::MatrixXd inputs = Eigen::MatrixXd::Zero(2, features);
  inputs(1, 0) = 0.5;
  models.full[3] = recon::GaussianProcess({}, inputs, Eigen::MatrixXd::Constant(2, 3, 0.1));
  return SampleOf("x.ossagp", models);
}

Perceptron Plain(Eigen::Index inputs, Eigen::Index outputs) {
  return {Eigen::RowVectorXf::Zero(inputs),
          Eigen::RowVectorXf::Ones(inputs),
          {{RowMatrix::Ones(inputs, outputs), Eigen::RowVectorXf::Zero(outputs)}}};
}

DamageSample Refinement() {
  recon::RefinementCascade cascade;
  cascade.people = 1;
  cascade.stages.emplace_back().fill(Plain(recon::kStageFeatures, 3));
  return SampleOf("x.ossarefine", cascade);
}

DamageSample Prior() {
  recon::PosturePrior prior;
  prior.frames = 100;
  prior.modes_m = Eigen::MatrixXd::Constant(recon::kBoneDims, 2, 0.1);
  prior.correlation_time_s = Eigen::VectorXd::Constant(2, 0.5);
  return SampleOf("x.ossaprior", prior);
}

// Of few points: those of the shipped one are all alike.
recon::BodySurface Surface() {
  auto surface =
      recon::BodySurface::Load(SourceFolder() / "tools/tracker/shipped" / recon::kShippedSurface);
  surface.points.resize(3);
  return surface;
}

DamageSample Person() {
  recon::PersonShape person;
  person.shape[1] = 0.5;
  person.frames = 3;
  person.weight = 2.5;
  const auto save = [](const recon::PersonShape& shape) {
    return Saved("x.ossaperson", [&](const fs::path& path) { shape.Save(path, Surface()); });
  };
  return {"x.ossaperson", save(person), [save](const fs::path& path) {
            return Reading{save(recon::PersonShape::Load(path, Surface()))};
          }};
}

DamageSample Recording() {
  const auto save = [](const fs::path& path) {
    depth::OniRecorder recorder(path, ExampleFrame(0, 4, 3).camera);
    for (int i = 0; i < 3; ++i) recorder.Write(ExampleFrame(i, 4, 3));
    recorder.Finish();
  };
  return {"x.oni", Saved("x.oni", save), ReadRecording};
}

DamageSample Png() {
  const auto save = [](const fs::path& path) {
    depth::WriteDepthPng(path, ExampleFrame(0, 16, 12).view());
  };
  return {"x.png", Saved("x.png", save), ReadRecording};
}

std::string Skeletons(int frames) {
  std::string text;
  for (int f = 0; f < frames; ++f) {
    recon::SkeletonFrame frame;
    frame.frame = f;
    frame.time_s = f / 30.0;
    text += recon::SkeletonJsonLine(frame) + "\n";
  }
  return text;
}

Reading ReadClips(const fs::path& path) {
  Reading reading;
  for (const recon::SkeletonClip& clip : recon::ReadSkeletonClips(path)) {
    reading.content += clip.name + "\n";
    for (const auto& frame : clip.sequence.frames)
      reading.content += recon::SkeletonJsonLine(frame);
  }
  return reading;
}

std::string Gzip(const std::string& content) {
  return Saved("x.gz", [&](const fs::path& path) {
    const gzFile file = gzopen(path.c_str(), "wb");
    gzwrite(file, content.data(), static_cast<unsigned>(content.size()));
    gzclose(file);
  });
}

std::vector<DamageSample> Archives() {
  const std::vector<std::pair<std::string, std::string>> members = {{"a.jsonl", Skeletons(3)},
                                                                    {"b.jsonl", Skeletons(5)}};
  const std::string tar =
      Saved("x.tar", [&](const fs::path& path) { recon::WriteTar(path, members); });
  return {{"x.jsonl.gz", Gzip(Skeletons(4)), ReadClips},
          {"x.tar.gz", Gzip(tar), ReadClips},
          {"x.zip", recon::Zip(members), ReadClips}};
}

DamageSample PackedShard() {
  tools::LabelledFrame frame;
  frame.depth = ExampleFrame(0, 16, 12);
  frame.parts = depth::Image<uint8_t>(16, 12);
  frame.users = depth::Image<uint8_t>(16, 12);
  frame.parts.at(5, 5) = 7;
  frame.users.at(5, 5) = 1;
  frame.bodies.resize(1);
  const auto save = [&](const fs::path& path) {
    const std::vector<std::vector<uint8_t>> blobs = {tools::PackFrame(frame)};
    tools::WriteShard(path, 0, blobs);
  };
  return {"x.shard", Saved("x.shard", save), [](const fs::path& path) {
            const tools::LabelledFrame read = tools::UnpackFrame(tools::ReadShard(path, 0, 1), 0);
            Reading reading;
            AppendFrame(read.depth, &reading.content);
            reading.content.append(read.parts.data.begin(), read.parts.data.end());
            reading.content.append(read.users.data.begin(), read.users.data.end());
            return reading;
          }};
}

}  // namespace

std::vector<DamageSample> ChecksummedSamples() {
  std::vector<DamageSample> samples = {
      Forest(),    Database(), Learned(),     Refinement(), Prior(),
      Recording(), Png(),      PackedShard(), Person(),     SampleOf("x.ossasurface", Surface())};
  for (DamageSample& archive : Archives()) samples.push_back(std::move(archive));
  return samples;
}

}  // namespace ossa::test
