#pragma once

namespace ossa::tracker {

/// "MAJOR.MINOR.PATCH" of the library that runs, which may be another than the headers'.
const char* Version();

}  // namespace ossa::tracker
