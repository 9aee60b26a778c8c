// ossa.compare, ossa.evaluate and ossa.learn: JSON texts as the commands write them.
#include <pybind11/stl.h>

#include <string>
#include <vector>

#include "depth/base/error.h"
#include "forest/forest.h"
#include "recon/models/learned_models.h"
#include "tools/experiments/compare/comparison.h"
#include "tools/experiments/experiment.h"
#include "tools/learning/evaluate.h"
#include "tools/learning/pair_recordings.h"
#include "tools/python/native/native.h"

namespace ossa::python {
namespace {

void ReadClock(const py::dict& given, tools::PairOptions& pairing) {
  pairing.max_offset_s = given["max_offset_s"].cast<double>();
  pairing.stop = [] { return !CheckSignals(); };
  const py::object time = given["time"];
  if (!py::isinstance<py::str>(time)) {
    pairing.time = tools::TimeAlignment::kFixed;
    pairing.offset_s = time.cast<double>();
  } else if (time.cast<std::string>() == "none") {
    pairing.time = tools::TimeAlignment::kNone;
  } else if (time.cast<std::string>() == "correlate") {
    pairing.time = tools::TimeAlignment::kCorrelate;
  } else {
    pairing.time = tools::TimeAlignment::kAuto;
  }
}

tools::CompareOptions CompareOptionsFrom(const py::dict& given) {
  tools::CompareOptions options;
  options.pairing.rigid = given["align"].cast<std::string>() == "rigid";
  options.pairing.found_only = given["joints"].cast<std::string>() == "found";
  ReadClock(given, options.pairing);
  options.reading.mapping_file = given["mapping"].cast<std::string>();
  options.reading.frame_s = given["frame_s"].cast<double>();
  options.reading.format = given["format"].cast<std::string>();
  options.only = given["only"].cast<std::vector<std::string>>();
  options.skip = given["skip"].cast<std::vector<std::string>>();
  options.seed = given["seed"].cast<uint64_t>();
  options.stop = [] { return !CheckSignals(); };
  return options;
}

// (JSON, warnings)
py::tuple Compare(const std::string& truth, const std::vector<std::string>& results,
                  const py::dict& given) {
  const tools::CompareOptions options = CompareOptionsFrom(given);
  const auto comparison = Interruptible([&] { return tools::Compare(truth, results, options); });
  return py::make_tuple(tools::ToJson(comparison), comparison.warnings);
}

std::string Evaluate(const std::string& path, const std::string& dataset, int64_t every) {
  return Interruptible([&] {
    const forest::ForestModel model = forest::ReadForestModel(path);
    const tools::DatasetReader reader{std::filesystem::path(dataset)};
    return tools::EvaluationJson(tools::Evaluate(model, path, reader, every,
                                                 [](int64_t, int64_t) { return CheckSignals(); }));
  });
}

// Returns the number of pairs, the warnings and the offsets of clocks that were found.
py::tuple Learn(const std::vector<std::string>& observed, const std::vector<std::string>& truth,
                const std::string& out, const py::dict& given) {
  recon::LearnOptions options;
  options.mixture.seed = options.correction.seed = given["seed"].cast<uint64_t>();
  options.mixture.regions = given["regions"].cast<int>();
  options.mixture.samples = given["samples"].cast<int>();
  options.most_pairs = given["pairs"].cast<size_t>();
  options.processes = !given["correction_only"].cast<bool>();
  tools::PairRecordingsOptions pairing;
  pairing.reading.mapping_file = given["mapping"].cast<std::string>();
  pairing.reading.frame_s = given["frame_s"].cast<double>();
  ReadClock(given, pairing.clock);
  std::vector<std::string> warnings, notes;
  pairing.read = [&](const std::vector<recon::SkeletonClip>& clips) {
    for (const recon::SkeletonClip& clip : clips) {
      const std::vector<std::string>& more = clip.sequence.warnings;
      warnings.insert(warnings.end(), more.begin(), more.end());
    }
    return CheckSignals();
  };
  pairing.note = [&](const std::string& line) { notes.push_back(line); };
  const size_t count = Interruptible([&] {
    const auto pairs = tools::PairRecordings(observed, truth, pairing);
    const auto models =
        recon::LearnedModels::Learn(pairs, options, [](int) { return CheckSignals(); });
    if (CheckSignals()) models.Save(out);
    return pairs.size();
  });
  return py::make_tuple(count, warnings, notes);
}

}  // namespace

void AddLearning(py::module_& module) {
  module.def("compare", &Compare, py::arg("truth"), py::arg("results"), py::arg("options"));
  module.def("evaluate", &Evaluate, py::arg("model"), py::arg("dataset"), py::arg("every"));
  module.def("learn", &Learn, py::arg("observed"), py::arg("truth"), py::arg("out"),
             py::arg("options"));
}

}  // namespace ossa::python
