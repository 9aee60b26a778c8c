// Pictures of the body model and of retargeted motions: to inspect part labels and retargeting.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "depth/base/error.h"
#include "depth/render/renderer.h"
#include "recon/body/body_model.h"
#include "recon/body/parts.h"
#include "recon/body/standard_body.h"
#include "recon/motion/mocap.h"
#include "tools/experiments/animated_png.h"
#include "tools/experiments/experiments_internal.h"

namespace ossa::tools {
namespace {

// Constants: sizes of pictures and messages, by eye.

constexpr int kWidth_px = 290;
constexpr int kHeight_px = 360;
constexpr double kDistance_m = 6.0;  // far, for little perspective
constexpr double kViewHeight_m = 2.1;

// A camera at the height of the body's centre that looks along -z of the world.
Eigen::Isometry3d CameraFromWorld(double yaw_rad, double middle_m) {
  // Seen from the front, the body's left (+x) is at the image's right: camera x is to the left.
  Eigen::Isometry3d cam_from_world = Eigen::Isometry3d::Identity();
  cam_from_world.linear() =
      Eigen::AngleAxisd(std::numbers::pi + yaw_rad, Eigen::Vector3d::UnitY()).toRotationMatrix();
  cam_from_world.translation() = Eigen::Vector3d(0.0, -middle_m, kDistance_m);
  return cam_from_world;
}

depth::Camera PictureCamera() {
  depth::Camera camera;
  camera.width = kWidth_px;
  camera.height = kHeight_px;
  camera.fx = camera.fy = kHeight_px * kDistance_m / kViewHeight_m;
  camera.cx = (kWidth_px - 1) / 2.0;
  camera.cy = (kHeight_px - 1) / 2.0;
  return camera;
}

/// The average body, undressed, in its part colours.
class BodyPainter {
 public:
  BodyPainter() : model_(recon::BodyModel::Load(recon::BodyFolder())), body_(model_.Shape({})) {
    for (size_t i = 0; i < model_.triangles().size(); ++i) {
      const auto& triangle = model_.triangles()[i];
      if (model_.vertex_layer()[triangle[0]] != recon::BodyLayer::kSkin) continue;
      part_.push_back(model_.triangle_part()[i]);
      mesh_.triangles.push_back(triangle);
    }
  }

  Picture Paint(const recon::RigPose& pose, double yaw_rad) {
    recon::RigPose upright = pose;
    upright.root_m.x() = upright.root_m.z() = 0.0;
    mesh_.vertices_m.resize(model_.vertex_count());
    model_.Skin(body_, body_.rest_m, upright, CameraFromWorld(yaw_rad, kViewHeight_m / 2 - 0.1),
                mesh_.vertices_m);
    depth::Renderer renderer;
    renderer.AddMesh(mesh_, false);
    const depth::RenderedImage seen = renderer.Render(PictureCamera());
    Picture picture(kWidth_px, kHeight_px);
    for (size_t i = 0; i < seen.triangle.data.size(); ++i) {
      const int32_t triangle = seen.triangle.data[i];
      if (triangle < 0) continue;
      const uint8_t part = part_[static_cast<size_t>(triangle)];
      ++pixels_[part];
      const recon::Rgb colour = recon::PartColour(part);
      const double light = 0.45 + 0.55 * static_cast<double>(seen.incidence.data[i]);
      const std::array<uint8_t, 3> rgb = {colour.r, colour.g, colour.b};
      for (size_t c = 0; c < 3; ++c) {
        picture.rgb[3 * i + c] = static_cast<uint8_t>(std::lround(light * rgb[c]));
      }
    }
    return picture;
  }

  const std::map<int, int64_t>& pixels() const { return pixels_; }

 private:
  recon::BodyModel model_;
  recon::ShapedBody body_;
  depth::TriangleMesh mesh_;
  std::vector<uint8_t> part_;  // of each triangle of mesh_
  std::map<int, int64_t> pixels_;
};

struct Moment {
  const recon::MotionClip* clip;
  size_t frame;
};

/// Some of the clips, spread over the list, each at `times` times spread over it.
std::vector<Moment> Chosen(const std::vector<recon::MotionClip>& clips, size_t count,
                           size_t times) {
  std::vector<Moment> chosen;
  for (size_t i = 0; i < std::min(count, clips.size()); ++i) {
    const recon::MotionClip& clip = clips[i * clips.size() / std::min(count, clips.size())];
    for (size_t k = 1; k <= times && !clip.frames.empty(); ++k) {
      chosen.push_back({&clip, k * clip.frames.size() / (times + 1)});
    }
  }
  return chosen;
}

/// Names by which clips are chosen, without duplicates: "authored/golf" of authored/golf/00, 01,
/// ...
std::string NamesOf(const std::vector<recon::MotionClip>& clips) {
  constexpr size_t kMost = 100;  // by eye: the line stays readable
  std::set<std::string> names;
  for (const recon::MotionClip& clip : clips) {
    names.insert(clip.name.substr(0, clip.name.rfind('/')));
  }
  std::vector<std::string> shown(names.begin(), names.end());
  const size_t more = shown.size() - std::min(shown.size(), kMost);
  shown.resize(shown.size() - more);
  return fmt::format("{}{}", fmt::join(shown, ", "),
                     more > 0 ? fmt::format(" and {} more", more) : "");
}

/// Clips whose name contains one of the words; all clips if there are no words. Throws InputError
/// for a word that no name contains.
std::vector<recon::MotionClip> Named(std::vector<recon::MotionClip> clips,
                                     const std::vector<std::string>& words) {
  const auto holds = [](const recon::MotionClip& clip, const std::string& word) {
    return clip.name.find(word) != std::string::npos;
  };
  for (const std::string& word : words) {
    if (std::ranges::any_of(clips, [&](const auto& clip) { return holds(clip, word); })) continue;
    throw InputError(fmt::format(
        "experiment body: only: no clip has '{}' in its name; there are {}", word, NamesOf(clips)));
  }
  std::erase_if(clips, [&](const recon::MotionClip& clip) {
    return !words.empty() &&
           std::ranges::none_of(words, [&](const auto& word) { return holds(clip, word); });
  });
  return clips;
}

struct BodySettings {
  std::vector<std::string> sources, only;
  int clips = 0, times = 0;
};

BodySettings ReadSettings(Parameters& parameters) {
  return {parameters.Motions("mocap"), parameters.Texts("only", {}),
          parameters.Integer("clips", 8, 1, 40), parameters.Integer("times", 1, 1, 20)};
}

}  // namespace

void ReadBodyParameters(ExperimentContext& context) { ReadSettings(context.parameters); }

std::vector<Table> RunBody(ExperimentContext& context) {
  const auto [sources, only, count, times] = ReadSettings(context.parameters);
  BodyPainter painter;
  recon::RigPose rest;
  rest.root_m = recon::StandardRigRest().head_m[0];
  std::vector<Picture> views;
  for (const double yaw_rad : {0.0, std::numbers::pi / 2, std::numbers::pi}) {
    context.ThrowIfInterrupted();
    views.push_back(painter.Paint(rest, yaw_rad));
  }
  WritePicture(context.out / "parts.png", Strip(views, 3));
  const auto pixels = painter.pixels();

  recon::MocapOptions options;
  options.seed = context.seed;
  options.stop = context.interrupted;
  const auto all = recon::LoadMocap(sources, options);
  context.ThrowIfInterrupted();
  const auto clips = Named(all, only);
  std::vector<Picture> poses;
  Table motions{
      "Motions on the body (motions.png, from the left)", {"clip", "frame", "of"}, {}, ""};
  for (const Moment& at : Chosen(clips, static_cast<size_t>(count), static_cast<size_t>(times))) {
    context.ThrowIfInterrupted();
    poses.push_back(painter.Paint(at.clip->frames[at.frame], 0.0));
    motions.rows.push_back(
        {at.clip->name, std::to_string(at.frame), std::to_string(at.clip->frames.size())});
  }
  WritePicture(context.out / "motions.png",
               Sheet(poses, times > 1 ? times : static_cast<int>(poses.size())));

  Table parts{"Pixels of each part, front, side and back (parts.png)", {"part", "pixels"}, {}, ""};
  for (int label = 1; label <= recon::kPartCount; ++label) {
    const auto it = pixels.find(label);
    parts.rows.push_back({std::string(recon::kPartNames[static_cast<size_t>(label)]),
                          std::to_string(it == pixels.end() ? 0 : it->second)});
  }
  return {parts, motions};
}

}  // namespace ossa::tools
