// ossa.Forest.
#include "forest/forest.h"

#include <pybind11/stl.h>

#include <string>
#include <utility>
#include <vector>

#include "forest/classification/classify.h"
#include "forest/proposals/propose.h"
#include "forest/proposals/relabel.h"
#include "tools/python/native/arrays.h"
#include "tools/python/native/native.h"
#include "tools/tracker/shipped.h"

namespace ossa::python {
namespace {

forest::ForestModel ReadForest(const std::string& path) {
  const GilReleased free;
  const auto file = path.empty() ? tracker::ShippedFile("body.ossa") : std::filesystem::path(path);
  return forest::ReadForestModel(file, forest::ModelUse::kRunOnly);
}

/// The output of a forest for one image.
struct ForestOutput {
  std::vector<uint8_t> parts;
  std::vector<float> probabilities;
  std::vector<std::vector<forest::Proposal>> proposals;
};

ForestOutput RunForest(const forest::ForestModel& model, const depth::DepthView& view,
                       const depth::Camera& camera, const std::vector<int32_t>& pixels,
                       bool propose) {
  const auto size = static_cast<size_t>(view.width) * static_cast<size_t>(view.height);
  const auto classes = static_cast<size_t>(model.class_count());
  ForestOutput output;
  const forest::Classification seen = forest::Classify(model, view, camera, pixels);
  output.proposals = forest::Propose(model, view, camera, seen);
  if (propose) return output;
  const std::vector<uint8_t> labels = forest::Relabel(model, view, camera, seen, output.proposals);
  output.parts.assign(size, 0);
  output.probabilities.assign(size * classes, 0.0F);
  for (size_t i = 0; i < seen.pixel.size(); ++i) {
    const auto pixel = static_cast<size_t>(seen.pixel[i]);
    output.parts[pixel] = labels[i];
    float* const of_pixel = &output.probabilities[pixel * classes];
    for (size_t c = 0; c < classes; ++c) of_pixel[c] = seen.Probability(i, c);
  }
  return output;
}

ForestOutput RunForestOn(const forest::ForestModel& model, const py::array& depth_mm,
                         const py::tuple& camera, const py::object& mask, bool propose) {
  const depth::DepthView view = ToView(depth_mm);
  const depth::Camera seen_by = ToCamera(camera, view);
  const std::vector<int32_t> pixels = ListPixels(view, mask);
  const GilReleased free;
  return RunForest(model, view, seen_by, pixels, propose);
}

py::tuple Classify(const forest::ForestModel& model, const py::array& depth_mm,
                   const py::tuple& camera, const py::object& mask) {
  ForestOutput output = RunForestOn(model, depth_mm, camera, mask, false);
  const py::ssize_t h = depth_mm.shape(0), w = depth_mm.shape(1);
  return py::make_tuple(ToArray(std::move(output.parts), {h, w}),
                        ToArray(std::move(output.probabilities), {h, w, model.class_count()}));
}

// {target: float64 [n, 5]: x y z, confidence, seen}
py::dict Propose(const forest::ForestModel& model, const py::array& depth_mm,
                 const py::tuple& camera, const py::object& mask) {
  const ForestOutput output = RunForestOn(model, depth_mm, camera, mask, true);
  py::dict proposals;
  for (size_t t = 0; t < output.proposals.size(); ++t) {
    std::vector<double> values;
    for (const forest::Proposal& p : output.proposals[t]) {
      values.insert(values.end(), p.position_m.begin(), p.position_m.end());
      values.insert(values.end(), {p.confidence, p.seen ? 1.0 : 0.0});
    }
    const auto count = static_cast<py::ssize_t>(output.proposals[t].size());
    proposals[py::str(model.targets()[t].name)] = ToArray(std::move(values), {count, 5});
  }
  return proposals;
}

}  // namespace

void AddForest(py::module_& module) {
  py::class_<forest::ForestModel>(module, "Forest")
      .def(py::init(&ReadForest), py::arg("path"))
      .def("classes", [](const forest::ForestModel& model) { return model.data().class_names; })
      .def("targets",
           [](const forest::ForestModel& model) {
             std::vector<std::string> names;
             for (const forest::ProposalTarget& target : model.targets())
               names.push_back(target.name);
             return names;
           })
      .def("card", [](const forest::ForestModel& model) { return model.manifest(); })
      .def("classify", &Classify, py::arg("depth_mm"), py::arg("camera"), py::arg("mask"))
      .def("propose", &Propose, py::arg("depth_mm"), py::arg("camera"), py::arg("mask"));
}

}  // namespace ossa::python
