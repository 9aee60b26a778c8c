#include "tools/commands/examples.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace ossa::commands {
namespace {

struct CommandExamples {
  std::string_view command;
  std::array<Example, 3> examples;
};

constexpr CommandExamples kExamples[] = {
    {"track",
     {{{"ossa track openni: --out me.jsonl --view", "the first camera; watch it in a browser"},
       {"ossa track recording.oni --out me.bvh --bones recording", "a recording, for Blender"},
       {"ossa track stills --out me.jsonl --picture me.png", "a folder of 16-bit PNGs"}}}},
    {"view",
     {{{"ossa view openni:", "the first camera, tracked, in a browser"},
       {"ossa view me.jsonl", "skeletons that were written before"},
       {"ossa view recording.oni --once --port 8081", "a recording, to its end"}}}},
    {"record",
     {{{"ossa record openni: --out me.oni --seconds 20", "twenty seconds of the first camera"},
       {"ossa record azure.mkv --out azure.oni", "another recording, for every OpenNI2 program"},
       {"ossa record openni: --out me.oni --wait 60",
        "wait a minute for a camera to be plugged in"}}}},
    {"reconstruct",
     {{{"ossa reconstruct sdk.csv --out better.jsonl",
        "an SDK's skeletons, completed and filtered"},
       {"ossa reconstruct me.jsonl --out me.bvh --physics on", "a physical character follows them"},
       {"ossa reconstruct me.jsonl --out me.trc --method one-euro", "smooth them only"}}}},
    {"fuse",
     {{{"ossa fuse left.jsonl right.jsonl --out both.jsonl",
        "estimate the camera poses from the people they see"},
       {"ossa fuse a.jsonl b.jsonl c.jsonl --save-extrinsics room.json",
        "also save the camera poses"},
       {"ossa fuse a.jsonl b.jsonl --extrinsics room.json --out me.glb",
        "use saved camera poses"}}}},
    {"compare",
     {{{"ossa compare truth.jsonl me.jsonl", "errors of the joints"},
       {"ossa compare truth.jsonl raw.jsonl best.jsonl --report r.html", "two results, as a page"},
       {"ossa compare truth.jsonl me.jsonl --joints found --json -", "numbers for a program"}}}},
    {"info",
     {{{"ossa info recording.oni", "frames, size and camera of a recording"},
       {"ossa info body.ossa", "a model's card"},
       {"ossa info recording.oni --picture sheet.png", "twelve of its frames in one picture"}}}},
    {"doctor",
     {{{"ossa doctor", "cameras, rights, drivers and models of this machine"},
       {"ossa doctor --quiet && ossa view openni:", "continue only without problems"},
       {"ossa doctor --root image", "the same for a machine whose files are in image/"}}}},
    {"evaluate",
     {{{"ossa evaluate body.ossa unseen", "accuracy of parts and joints"},
       {"ossa evaluate body.ossa unseen --report report.html", "the same as a page"},
       {"ossa evaluate body.ossa unseen --every 10 --json n.json", "every tenth frame"}}}},
    {"experiment",
     {{{"ossa experiment shum-2013 --out out/shum-2013", "a paper's tables beside ours"},
       {"ossa experiment real --shared recordings --out out/real", "on real depth"},
       {"ossa experiment sdk --shared recordings --out out/sdk --threads 2", "on two cores"}}}},
    {"study",
     {{{"ossa study study.toml", "an experiment as a file describes it"},
       {"ossa study study.toml --quiet", "without progress"},
       {"nice ossa study study.toml", "beside other work; the same command resumes it"}}}},
    {"database",
     {{{"ossa database --mocap authored --out all.ossadb", "from ossa's own motion"},
       {"ossa database --mocap cmu --out cmu.ossadb", "from a folder of BVH or AMC files"},
       {"ossa database --mocap cmu --out s.ossadb --threshold 0.1", "keep more postures"}}}},
    {"learn",
     {{{"ossa learn --observed sdk.csv --truth vicon.csv --out sensor.ossagp",
        "from one recording"},
       {"ossa learn --observed a.csv b.csv --truth c.csv d.csv --out s.ossagp", "from several"},
       {"ossa learn --observed o.jsonl --truth t.jsonl --out s.ossagp --pairs 500",
        "from a sample of 500 pairs"}}}},
    {"refine",
     {{{"ossa refine more --model body.ossa --out body.ossarefine", "a first stage"},
       {"ossa refine m --model b.ossa --after one.ossarefine --out two.ossarefine",
        "a second stage, on other people"},
       {"ossa refine more --model body.ossa --out body.ossarefine --epochs 4",
        "a quick stage, to try it out"}}}},
    {"crop",
     {{{"ossa crop data --out crops", "the people of a data set of ossa render"},
       {"ossa crop data --out crops --threads 1", "on one core"},
       {"nice ossa crop data --out crops --quiet", "beside other work"}}}},
    {"pack-network",
     {{{"ossa pack-network weights.npy --out my.ossanet",
        "weights of tools/learning/train_pose_network.py"},
       {"ossa pack-network weights.npy --out my.ossanet --people 400000",
        "note for ossa info how many people it saw"},
       {"ossa track clip --out me.jsonl --pose-network my.ossanet", "track with it"}}}},
    {"prior",
     {{{"ossa prior --mocap authored --out all.ossaprior", "from ossa's own motion"},
       {"ossa prior --mocap cmu --mocap authored --out cmu.ossaprior", "from a folder as well"},
       {"ossa track clip --out me.jsonl --prior cmu.ossaprior", "track with it"}}}},
    {"surface",
     {{{"ossa surface --mocap authored --out body.ossasurface", "from ossa's own motion"},
       {"ossa surface --mocap authored --out b.ossasurface --points 400", "a coarser body"},
       {"ossa track clip --out me.jsonl --surface body.ossasurface", "track with it"}}}},
    {"train",
     {{{"ossa train data --out body.ossa", "a forest from a data set of ossa render"},
       {"ossa train data --out body.ossa --resume", "continue an interrupted run"},
       {"mpirun -np 4 ossa train data --out body.ossa", "four processes share the work"}}}},
    {"render",
     {{{"ossa render --mocap authored --out data --frames 10000 --view any",
        "a data set to train on"},
       {"ossa render --mocap authored --out clip --frames 90 --sequence",
        "a clip of a moving person"},
       {"mpirun -np 4 ossa render --mocap cmu --out data --frames 50000",
        "four processes share the work"}}}},
};

}  // namespace

std::span<const Example> FindExamples(std::string_view command) {
  const auto is_it = [&](const CommandExamples& of) { return of.command == command; };
  const auto* found = std::find_if(std::begin(kExamples), std::end(kExamples), is_it);
  if (found == std::end(kExamples)) return {};
  return found->examples;
}

std::string ExamplesText(std::string_view command) {
  std::string text;
  for (const Example& example : FindExamples(command)) {
    text += fmt::format("{}  {}\n      {}", text.empty() ? "Examples:\n" : "\n", example.line,
                        example.purpose);
  }
  return text;
}

}  // namespace ossa::commands
