#include "forest/training/train.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <memory>

#include "depth/base/error.h"
#include "depth/base/train_interrupted.h"
#include "forest/classification/classify.h"
#include "forest/proposals/propose.h"
#include "tests/forest/ball_figure.h"
#include "tests/support/temporary_folder.h"

namespace ossa::forest {
namespace {

using test::BallFigures;
using test::BallModel;
using test::BallVocabulary;
using test::QuickOptions;
using test::ToBytes;

// Share of right pixels on figures never seen.
double Accuracy(const ForestModel& model) {
  const BallFigures unseen(60, 99);
  int64_t right = 0;
  int64_t all = 0;
  for (size_t i = 0; i < unseen.size(); ++i) {
    const TrainingImage image = unseen.Read(i);
    const Classification result =
        Classify(model, test::MakeView(image), image.camera, test::ObjectPixels(image));
    for (size_t p = 0; p < result.pixel.size(); ++p) {
      right += result.label[p] == image.label[static_cast<size_t>(result.pixel[p])] ? 1 : 0;
      ++all;
    }
  }
  return static_cast<double>(right) / static_cast<double>(all);
}

TEST(Train, GeneralisesToUnseenFigures) {
  // Balls meet in edges of a pixel's width whose owner noise decides: about 3 % of all pixels.
  EXPECT_GT(Accuracy(BallModel()), 0.93);
}

TEST(Train, DistinguishesFrontAndBackByTheWholeFigure) {
  const BallFigures unseen(60, 77);
  int right = 0;
  for (size_t i = 0; i < unseen.size(); ++i) {
    const TrainingImage image = unseen.Read(i);
    const Classification result =
        Classify(BallModel(), test::MakeView(image), image.camera, test::ObjectPixels(image));
    right += result.context[image.context] > 0.5F ? 1 : 0;
  }
  EXPECT_GE(right, 57);  // the nose is 2 to 6 pixels; in 5 % of views a hand's edge looks like it
}

// A split by context gains nothing where all images have the same: the node is split by class, not
// left as a leaf of all its pixels.
TEST(Train, SplitsByClassWhereContextsGainNothing) {
  const test::ChangedFigures figures([](TrainingImage& image) { image.context = 0; });
  TrainOptions options = QuickOptions();
  options.context_share = 1.0;
  const ForestModel model = Train(figures, BallVocabulary(), options);
  for (const Tree& tree : model.data().trees) EXPECT_GT(tree.leaf_count(), 8U);
}

TEST(Train, ProposesCentresOfBalls) {
  const BallFigures unseen(20, 55);
  int near = 0;
  for (size_t i = 0; i < unseen.size(); ++i) {
    const TrainingImage image = unseen.Read(i);
    const Classification result =
        Classify(BallModel(), test::MakeView(image), image.camera, test::ObjectPixels(image));
    const auto proposals = Propose(BallModel(), test::MakeView(image), image.camera, result);
    for (size_t t = 0; t < proposals.size(); ++t) {
      if (proposals[t].empty()) continue;
      const auto error = (proposals[t][0].position_m.cast<float>() - image.target_m[t]).norm();
      near += error < 0.1F ? 1 : 0;
    }
  }
  EXPECT_GE(near, 50);  // of 60: near nine in ten, less the noise of a small draw
}

TEST(LearnProposals, ConfidencesSeparateRightFromWrong) {
  const ForestModel model = LearnProposals(BallModel(), BallFigures(100, 5), 100, 0);
  const BallFigures unseen(40, 66);
  double right_sum = 0, wrong_sum = 0;
  int right = 0, wrong = 0;
  for (size_t i = 0; i < unseen.size(); ++i) {
    const TrainingImage image = unseen.Read(i);
    const Classification result =
        Classify(model, test::MakeView(image), image.camera, test::ObjectPixels(image));
    const auto proposals = Propose(model, test::MakeView(image), image.camera, result);
    for (size_t t = 0; t < proposals.size(); ++t) {
      for (const Proposal& proposal : proposals[t]) {
        const bool hit = (proposal.position_m.cast<float>() - image.target_m[t]).norm() < 0.1F;
        (hit ? right_sum : wrong_sum) += proposal.confidence;
        ++(hit ? right : wrong);
      }
    }
  }
  EXPECT_GT(right, 108);  // of 120 joints: 9 in 10
  EXPECT_GT(right_sum / right, 0.8);
  EXPECT_LT(wrong_sum, 0.5 * std::max(wrong, 1));
}

// It would read targets and contexts that do not exist.
TEST(LearnProposals, RefusesTruthOfAnotherVocabulary) {
  const test::ChangedFigures fewer_targets([](TrainingImage& i) { i.target_m.pop_back(); });
  const test::ChangedFigures other_contexts([](TrainingImage& i) { i.context = 2; });
  for (const TrainingSource* other : {&fewer_targets, &other_contexts}) {
    EXPECT_THROW(LearnProposals(BallModel(), *other, 20, 1), InputError);
  }
}

// Nothing could be learned from them.
TEST(LearnProposals, RefusesImagesWithoutObjects) {
  const test::ChangedFigures nobody([](TrainingImage& i) { i.label.assign(i.label.size(), 0); });
  EXPECT_THROW(LearnProposals(BallModel(), nobody, 20, 1), InputError);
}

TEST(Train, GivesTheSameBytesForAnyNumberOfThreads) {
  TrainOptions options = QuickOptions();
  options.threads = 1;
  const BallFigures figures(60, 3);
  const auto one = ToBytes(Train(figures, BallVocabulary(), options));
  options.threads = 4;
  EXPECT_EQ(one, ToBytes(Train(figures, BallVocabulary(), options)));
}

TEST(Train, GivesTheSameBytesWhenImagesStreamInParts) {
  TrainOptions options = QuickOptions();
  options.trees = 1;
  options.depth = 5;
  const BallFigures figures(200, 3);
  const auto whole = ToBytes(Train(figures, BallVocabulary(), options));
  options.memory_bytes = uint64_t{1} << 20U;  // 200 images take 3 MB
  EXPECT_EQ(whole, ToBytes(Train(figures, BallVocabulary(), options)));
}

// Options under which training ends after a number of levels; they own their counter.
TrainOptions StoppingAfter(int levels, TrainOptions options) {
  const auto seen = std::make_shared<int>(0);
  options.progress = [seen](const TrainProgress& p) { *seen += p.nodes > 0 ? 1 : 0; };
  options.stop = [seen, levels] { return *seen >= levels; };
  return options;
}

TEST(Train, ResumesToTheSameBytes) {
  const ossa::test::TemporaryFolder folder;
  const BallFigures figures(60, 3);
  TrainOptions options = QuickOptions();
  const auto unbroken = ToBytes(Train(figures, BallVocabulary(), options));
  options.checkpoint = folder / "checkpoint";
  options.resume = true;
  for (int levels = 3; levels <= 5; ++levels) {
    const TrainOptions broken_off = StoppingAfter(levels, options);
    EXPECT_THROW(Train(figures, BallVocabulary(), broken_off), TrainInterrupted);
  }
  EXPECT_EQ(unbroken, ToBytes(Train(figures, BallVocabulary(), options)));
}

TEST(Train, StopsWhileLeavesAreFilledAndResumesToTheSameBytes) {
  const ossa::test::TemporaryFolder folder;
  const BallFigures figures(60, 3);
  TrainOptions options = QuickOptions();
  const auto unbroken = ToBytes(Train(figures, BallVocabulary(), options));
  options.checkpoint = folder / "checkpoint";
  options.resume = true;
  TrainOptions broken_off = options;
  bool is_filling = false;
  broken_off.progress = [&](const TrainProgress& p) { is_filling = p.level == p.levels; };
  broken_off.stop = [&] { return is_filling; };
  EXPECT_THROW(Train(figures, BallVocabulary(), broken_off), TrainInterrupted);
  EXPECT_EQ(unbroken, ToBytes(Train(figures, BallVocabulary(), options)));
}

// It must not read all images several times more before it stops.
TEST(Train, StopsWhileImagesThatStreamAreRead) {
  class CountedFigures final : public TrainingSource {
   public:
    size_t size() const override { return figures_.size(); }
    TrainingImage Read(size_t index) const override {
      ++reads;
      return figures_.Read(index);
    }
    mutable std::atomic<size_t> reads = 0;

   private:
    BallFigures figures_{300, 3};
  };
  const CountedFigures figures;
  constexpr size_t kSomeMore = 50;  // than all images once
  TrainOptions options = QuickOptions();
  options.memory_bytes = uint64_t{1} << 20U;  // 300 images take 4 MB
  options.stop = [&] { return figures.reads > figures.size() + kSomeMore; };
  EXPECT_THROW(Train(figures, BallVocabulary(), options), TrainInterrupted);
  constexpr size_t kThreads = 64;  // each may be at an image
  EXPECT_LT(figures.reads, figures.size() + kSomeMore + kThreads);
}

TEST(Train, RefusesTheCheckpointOfAnotherRun) {
  const ossa::test::TemporaryFolder folder;
  TrainOptions options = QuickOptions();
  options.depth = 2;
  options.checkpoint = folder / "checkpoint";
  options.fingerprint = "ten figures";
  Train(BallFigures(10, 3), BallVocabulary(), options);
  options.resume = true;
  const auto complaint = [](const TrainOptions& other) {
    try {
      Train(BallFigures(10, 3), BallVocabulary(), other);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(complaint(options), "");
  TrainOptions other = options;
  other.seed = (uint64_t{1} << 60U) + 1;
  EXPECT_TRUE(
      complaint(other).ends_with("seed: expected 1152921504606846977 as in this run, found 1"))
      << complaint(other);
  other = options;
  other.min_gain_bits += 1e-9;  // printed with six digits it was the same
  EXPECT_NE(complaint(other).find("min-gain: expected "), std::string::npos) << complaint(other);
  other = options;
  other.fingerprint = "others";
  EXPECT_TRUE(complaint(other).ends_with("data: expected others as in this run, found ten figures"))
      << complaint(other);
}

// One class only: there is nothing to distinguish.
class OnlyBellies final : public TrainingSource {
 public:
  size_t size() const override { return 4; }
  TrainingImage Read(size_t index) const override {
    TrainingImage image = BallFigures(4, 1).Read(index);
    for (uint8_t& label : image.label) label = label != 0 ? 1 : 0;
    return image;
  }
};

TEST(Train, RefusesDataWithoutImagesOrWithOneClass) {
  EXPECT_THROW(Train(BallFigures(0, 1), BallVocabulary(), QuickOptions()), InputError);
  EXPECT_THROW(Train(OnlyBellies(), BallVocabulary(), QuickOptions()), InputError);
}

TEST(Train, NamesALabelThatTheVocabularyLacks) {
  TrainingVocabulary vocabulary = BallVocabulary();
  vocabulary.class_names.pop_back();
  vocabulary.targets[0].classes = {2};
  try {
    Train(BallFigures(4, 1), vocabulary, QuickOptions());
    FAIL() << "label 5 of 5 classes was not noticed";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("label 5"), std::string::npos) << error.what();
  }
}

TEST(Train, AcceptsAClassWithoutImages) {
  TrainingVocabulary vocabulary = BallVocabulary();
  vocabulary.class_names.emplace_back("tail");
  EXPECT_NO_THROW(Train(BallFigures(20, 1), vocabulary, QuickOptions()));
}

TEST(TrainOptions, NamesTheOptionOutOfRange) {
  TrainOptions options;
  options.depth = 41;
  try {
    options.Check();
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("depth"), std::string::npos);
  }
}

}  // namespace
}  // namespace ossa::forest
