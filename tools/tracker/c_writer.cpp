// Skeleton files, for ossa_c.h.
#include <memory>
#include <optional>
#include <string>

#include "depth/base/atomic_file.h"
#include "depth/base/error.h"
#include "recon/files/skeleton_io.h"
#include "recon/files/skeleton_writer.h"
#include "tools/tracker/body_mesh_file.h"
#include "tools/tracker/c_interface_internal.h"
#include "tools/tracker/c_tracker_internal.h"
#include "tools/tracker/skeleton_record.h"

struct ossa_writer {
  ossa_writer(const std::string& path, const ossa::recon::SkeletonWriteOptions& options)
      : file(path, options) {}

  ossa::recon::SkeletonWriter file;
  ossa::tracker::PostureKind posture = ossa::tracker::PostureKind::kFinal;
  std::optional<ossa::DiskFull> full;  // the failure that stopped writing
  bool is_finished = false;
};

namespace {

using ossa::tracker::Guarded;
using ossa::tracker::ReadStruct;
using ossa::tracker::RequireNotNull;
using ossa::tracker::TextOr;

std::unique_ptr<ossa_writer> OpenWriter(const std::string& path, const ossa_writer_options& given) {
  ossa::recon::CheckSkeletonExtension(path);
  const ossa::tracker::WriteChoice choice = {TextOr(given.names, ""), TextOr(given.surface, ""),
                                             TextOr(given.mesh, "")};
  const auto posture = ossa::tracker::ParsePostureKind(TextOr(given.posture, "final"));
  auto writer = std::make_unique<ossa_writer>(path, ossa::tracker::LoadWriteOptions(path, choice));
  writer->posture = posture;
  return writer;
}

ossa_writer& RequireUnfinished(ossa_writer* writer, const char* call) {
  RequireNotNull(writer, call, "a writer");
  if (!writer->is_finished) return *writer;
  throw std::invalid_argument(std::string(call) + ": expected a writer that is not finished");
}

void Write(const ossa_tracker& tracker, ossa_writer& writer) {
  if (writer.full) throw ossa::DiskFull(*writer.full);
  for (const ossa::tracker::Body& body : tracker.last.bodies) {
    if (body.shape) writer.file.SetShape(body.id, body.shape->shape);
  }
  ossa::recon::SkeletonFrame record = ToRecord(tracker.last, writer.posture);
  if (tracker.is_seated) ossa::tracker::KeepSeatedJoints(record);
  try {
    writer.file.Write(record);
  } catch (const ossa::DiskFull& full) {
    writer.full = full;
    throw;
  }
}

// If the disk is full, keeps the complete frames; the error states their number.
void FinishFile(ossa_writer& writer) {
  try {
    if (writer.full) throw ossa::DiskFull(*writer.full);
    writer.file.Finish();
  } catch (const ossa::DiskFull& full) {
    const int64_t kept = writer.file.FinishWithWhatFits();
    throw ossa::InputError(std::string(full.what()) + " " + std::to_string(kept) +
                           " frames were kept");
  }
}

}  // namespace

ossa_writer* ossa_writer_open(const char* path, const ossa_writer_options* options) {
  ossa_writer* writer = nullptr;
  Guarded([&] {
    RequireNotNull(path, "ossa_writer_open", "a path");
    ossa_writer_options given{};
    if (options != nullptr) given = ReadStruct(*options);
    writer = OpenWriter(path, given).release();
    return OSSA_OK;
  });
  return writer;
}

ossa_status ossa_writer_write(ossa_writer* writer, const ossa_tracker* tracker) {
  return Guarded([&] {
    ossa_writer& open = RequireUnfinished(writer, "ossa_writer_write");
    RequireNotNull(tracker, "ossa_writer_write", "a tracker");
    Write(*tracker, open);
    return OSSA_OK;
  });
}

ossa_status ossa_writer_finish(ossa_writer* writer) {
  return Guarded([&] {
    ossa_writer& open = RequireUnfinished(writer, "ossa_writer_finish");
    open.is_finished = true;
    FinishFile(open);
    return OSSA_OK;
  });
}

void ossa_writer_close(ossa_writer* writer) { delete writer; }
