#include "depth/base/line_file.h"

namespace ossa {

LineFile::LineFile(const std::filesystem::path& path, std::string_view head) : file_(path) {
  Append(head);
}

// Flushed, so that later failures do not affect these lines.
void LineFile::Append(std::string_view lines) {
  file_.stream() << lines;
  file_.Flush();
  end_ += lines.size();
}

void LineFile::Finish() { file_.Commit(); }

void LineFile::FinishWithWhatFits() {
  file_.CutTo(end_);
  file_.Commit();
}

}  // namespace ossa
