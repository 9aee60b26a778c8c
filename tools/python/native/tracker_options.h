#pragma once
#include <map>
#include <string>
#include <vector>

#include "recon/fit/surface_fit.h"
#include "tools/python/native/native.h"
#include "tools/tracker/tracker.h"

namespace ossa::python {

/// The keywords of ossa.Tracker (ossa/_tracker.py) as options; models and people are left empty.
tracker::TrackerOptions ReadTrackerOptions(const py::dict& given);

/// None: the preset of the method; a string: a preset; a dict: the parameters of One Euro or Holt
/// smoothing.
tracker::SmoothingOptions ReadSmoothing(const py::object& given, const std::string& method);

/// Body shapes of .ossaperson files, by id: 1, 2 ... in the order of the files. `surface` may be
/// null if there are no files; else throws InputError.
std::map<int, recon::PersonShape> LoadPeople(const std::vector<std::string>& paths,
                                             const recon::BodySurface* surface);

}  // namespace ossa::python
