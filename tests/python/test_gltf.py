"""`ossa track --out FILE.glb` and what else writes one, by readers that are not ours: pygltflib with NumPy, trimesh,
Khronos' validator (npm), Blender (PyPI's bpy; skipped where tests/support/pypi.py did not fetch it)."""

import json
import os
import pathlib
import pickle
import shutil
import subprocess
import sys

import numpy as np
import pytest

import ossa
from gltf_scene import Scene

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import pypi  # noqa: E402

# A bone of the humanoid and our joint where it begins.
BONES = {"hips": "HipCenter", "spine": "HipCenter", "chest": "Spine", "neck": "ShoulderCenter", "head": "Head"}
MIXAMO = {"hips": "Hips", "spine": "Spine", "chest": "Spine1", "neck": "Neck", "head": "Head"}
for side in ("Left", "Right"):
    for vrm, mixamo, joint in (
        ("Shoulder", "Shoulder", "ShoulderCenter"), ("UpperArm", "Arm", "Shoulder" + side),
        ("LowerArm", "ForeArm", "Elbow" + side), ("Hand", "Hand", "Wrist" + side),
        ("UpperLeg", "UpLeg", "Hip" + side), ("LowerLeg", "Leg", "Knee" + side),
        ("Foot", "Foot", "Ankle" + side), ("Toes", "ToeBase", "Foot" + side),
        ("Hand_end", "Hand_end", "Hand" + side),
    ):  # fmt: skip
        BONES[side.lower() + vrm] = joint
        MIXAMO[side.lower() + vrm] = side + mixamo
NAMES = {"vrm": lambda n: n, "cmu": MIXAMO.get, "mixamo": lambda n: "mixamorig:" + MIXAMO[n]}
MOST_M = 0.001


@pytest.fixture(scope="session")
def pygltflib():
    return pytest.importorskip("pygltflib")


@pytest.fixture(scope="session")
def track(clip, command, tmp_path_factory):
    """(path of the .glb, frames of the .jsonl) of the clip with these options."""
    folder, made = tmp_path_factory.mktemp("gltf"), {}

    def run(*options):
        if options not in made:
            stem = folder / f"x{len(made)}"
            command("track", clip, "--out", f"{stem}.glb", "--quiet", *options)
            fit = options if "--fit" in options else ()
            command("track", clip, "--out", f"{stem}.jsonl", "--quiet", *fit)
            lines = open(f"{stem}.jsonl").read().splitlines()
            made[options] = f"{stem}.glb", [json.loads(line) for line in lines]
        return made[options]

    return run


@pytest.mark.parametrize("names, options", [
    ("vrm", ()), ("vrm", ("--fit", "off")), ("cmu", ("--bvh-names", "cmu")), ("mixamo", ("--bvh-names", "mixamo")),
])  # fmt: skip
def test_skin_joints_are_at_the_skeleton_joints(names, options, track, pygltflib):
    path, frames = track(*options)
    scene = Scene(pygltflib, path)
    person = scene.person(frames[0]["bodies"][0]["id"])
    assert set(scene.gltf.skins[0].joints) >= {person[NAMES[names](bone)] for bone in BONES}
    for frame in frames:
        world = scene.world(frame["time_s"] - frames[0]["time_s"])
        joints = frame["bodies"][0]["joints"]
        for bone, joint in BONES.items():
            place = world[person[NAMES[names](bone)], :3, 3]
            assert np.linalg.norm(place - joints[joint]["p"]) < MOST_M, (bone, frame["frame"])


def test_rest_pose_is_a_t_pose_facing_z_with_the_left_at_x(track, pygltflib):
    scene = Scene(pygltflib, track()[0])
    world, person = scene.world(), scene.person(1)
    place = {bone: world[person[bone], :3, 3] for bone in BONES}

    def along(begin, end):
        way = place[end] - place[begin]
        return way / np.linalg.norm(way)

    for side, out in (("left", 1), ("right", -1)):
        for begin, end in (("UpperArm", "LowerArm"), ("LowerArm", "Hand"), ("Hand", "Hand_end")):
            assert out * along(side + begin, side + end)[0] > 0.999
        for begin, end in (("UpperLeg", "LowerLeg"), ("LowerLeg", "Foot")):
            assert along(side + begin, side + end)[1] < -0.999
        assert along(side + "Foot", side + "Toes")[2] > 0.8
    assert along("hips", "head")[1] > 0.98
    assert all((np.array(turn) == [0, 0, 0, 1]).all() for _, turn, _ in scene.rest())
    skin, _ = scene.skin(0, world)
    assert abs(skin[:, 1].min()) < 1e-5 and 1.2 < skin[:, 1].max() < 2.1  # metres, feet on the ground


def test_keyframes_have_the_times_of_the_frames(track, pygltflib):
    path, frames = track()
    scene = Scene(pygltflib, path)
    times = [frame["time_s"] - frames[0]["time_s"] for frame in frames]
    assert all(np.allclose(track_times, times, atol=1e-6) for _, _, track_times, _, _ in scene.tracks)


def test_fitted_skin_lies_on_the_depth_image(track, images, models, pygltflib):
    path, frames = track("--fit", "on")
    scene = Scene(pygltflib, path)
    tracker = ossa.Tracker(models=models, fit=True)
    away = []
    for image in images:
        frame = tracker.track(*image)
        skin, _ = scene.skin(0, scene.world(frame.time_s - frames[0]["time_s"]))
        points = points_of(image, frame.users)
        away.append(np.median(distances(points, skin)))
    assert np.median(away) < 0.03  # vertices are 3 to 5 cm apart; 1 cm between them


def points_of(image, users):
    v, u = np.nonzero((users > 0) & (image.depth_mm > 0))
    v, u = v[::37], u[::37]
    z = image.depth_mm[v, u] / 1000
    camera = image.camera
    return np.stack([(camera.cx - u) * z / camera.fx, (camera.cy - v) * z / camera.fy, z], axis=1)


def distances(points, vertices):
    return np.linalg.norm(points[:, None] - vertices[None], axis=2).min(axis=1)


def test_fitted_body_has_a_mesh(images, models):
    tracker = ossa.Tracker(models=models, fit=True)
    for image in images[:6]:
        frame = tracker.track(*image)
        body = frame.bodies[0]
    mesh = body.mesh
    assert mesh.vertices.dtype == np.float64 and mesh.vertices.shape[1:] == (3,)
    assert mesh.faces.dtype == np.int32 and mesh.faces.shape[1:] == (3,)
    assert mesh.faces.min() == 0 and mesh.faces.max() == len(mesh.vertices) - 1
    assert np.median(distances(points_of(image, frame.users), mesh.vertices)) < 0.03
    assert 1.4 < body.fit.stature_m < 2.0 and 0.5 < body.fit.explained <= 1
    assert body.fit.shape.shape == (10,) and body.fit.residuals_m.shape == (len(ossa.SEGMENTS),)
    assert body.fit.joints.shape == (20, 3) and body.fit.orientations.shape == (18, 4)
    assert np.abs(body.fit.joints - body.joints).max() < 0.15
    assert (np.linalg.eigvalsh(body.fit.covariance_m2) > 0).all()


def test_pickled_fit_keeps_its_mesh(images, models):
    fit = ossa.Tracker(models=models).track(*images[0]).bodies[0].fit
    again = pickle.loads(pickle.dumps(fit))
    assert (again.mesh.vertices == fit.mesh.vertices).all() and again.mesh.faces.any()
    assert fit.mesh is fit.mesh


def test_body_without_a_fit_has_no_mesh(images, models):
    body = ossa.Tracker(models=models, fit=False).track(*images[0]).bodies[0]
    assert body.mesh is None and body.fit is None


SHIPPED = pathlib.Path(__file__).parents[2] / "tools/tracker/shipped"
OWN = {"surface": SHIPPED / "body.ossasurface", "mesh": SHIPPED / "body.ossamesh"}


def test_custom_skin_is_used_for_bodies_and_files(images, tmp_path):
    tracker = ossa.Tracker(**OWN)
    body = [tracker.track(*image) for image in images[:3]][-1].bodies[0]
    assert len(body.mesh.vertices) > 1000
    sequence = ossa.Sequence([0.0], body.joints[None], ids=[body.id])
    size = {}
    for name, how in {
        "shipped": {}, "own": OWN, "none": {"mesh": "none"}, "like": {**OWN, "shapes": {body.id: body.fit.shape}},
    }.items():  # fmt: skip
        path = tmp_path / f"{name}.glb"
        ossa.write_skeletons(sequence, path, **how)
        size[name] = path.read_bytes()
    assert size["own"] == size["shipped"] and len(size["none"]) < len(size["own"]) / 2
    assert size["like"] != size["own"], "in the shape that was fitted"


@pytest.mark.parametrize("name, how, says", [
    ("x.glb", {"surface": "mine.ossasurface"}, "surface: expected its skin"),
    ("x.csv", {"mesh": "none"}, "expected a .glb"),
    ("x.csv", {"shapes": {}}, "shapes: expected a .glb"),
    ("x.glb", {"shapes": {1: [0.0] * 9}}, "float64 \\[10\\]"),
    ("x.glb", {"shapes": {1: [np.nan] * 10}}, "finite"),
    ("x.glb", {"shapes": [1]}, "dict"),
])  # fmt: skip
def test_unusable_skin_is_refused(name, how, says, frames, tmp_path):
    sequence = ossa.Sequence.from_frames(frames[:2])
    with pytest.raises(ossa.InputError, match=says):
        ossa.write_skeletons(sequence, tmp_path / name, **how)
    assert not list(tmp_path.iterdir())


def test_custom_surface_needs_its_skin():
    with pytest.raises(ossa.InputError, match="surface: expected its skin with it"):
        ossa.Tracker(surface=OWN["surface"])


def test_several_people_are_visible_in_their_own_frames_only(frames, tmp_path, pygltflib):
    first = ossa.Sequence.from_frames(frames[:9])
    rows = len(first.times)
    joints = np.concatenate([first.joints, first.joints[3:6] + [0.8, 0, 0]])
    times = np.concatenate([first.times, first.times[3:6]])
    order = np.argsort(times, kind="stable")
    ids = np.concatenate([np.full(rows, 4), np.full(3, 7)])
    both = ossa.Sequence(times[order], joints[order], ids=ids[order],
                         frames=np.concatenate([first.frames, first.frames[3:6]])[order])  # fmt: skip
    ossa.write_skeletons(both, tmp_path / "two.glb")
    scene = Scene(pygltflib, tmp_path / "two.glb")
    assert len(scene.gltf.skins) == 2
    root = scene.person(7)
    for row, time_s in enumerate(first.times):
        world = scene.world(time_s - first.times[0] + 1e-4)
        size = np.linalg.norm(world[root["person 7"], :3, 0])
        assert size == (1 if 3 <= row < 6 else 0), row
        assert np.linalg.norm(world[scene.person(4)["person 4"], :3, 0]) == 1
        if size:
            head = world[root["head"], :3, 3] - [0.8, 0, 0]
            assert np.linalg.norm(head - first.joints[row, ossa.Joint.Head]) < 0.01


def test_reconstruct_writes_a_glb_from_a_skeleton_file(command, clip, tmp_path, pygltflib):
    command("reconstruct", clip / "truth.jsonl", "--method", "none", "--out", tmp_path / "x.glb", "--quiet")
    truth = ossa.read_skeletons(clip / "truth.jsonl")
    scene = Scene(pygltflib, tmp_path / "x.glb")
    for row in (0, -1):
        world = scene.world(truth.times[row] - truth.times[0])
        head = world[scene.person(int(truth.ids[row]))["head"], :3, 3]
        assert np.linalg.norm(head - truth.joints[row, ossa.Joint.Head]) < MOST_M


def test_trimesh_reads_a_closed_surface_that_faces_outwards(track):
    trimesh = pytest.importorskip("trimesh")
    scene = trimesh.load(track()[0])
    body = next(iter(scene.geometry.values()))
    assert 0.03 < body.volume < 0.15  # m3 of a person; negative where triangles face inwards
    assert (body.face_normals * body.vertex_normals[body.faces[:, 0]]).sum(axis=1).mean() > 0.8


def test_khronos_validator_reports_nothing(track):
    folder = os.path.join(sys.prefix, "npm")
    if not shutil.which("node") or not os.path.isdir(os.path.join(folder, "node_modules/gltf-validator")):
        pytest.skip("npm's gltf-validator cannot be had")
    script = (
        "require('gltf-validator').validateBytes(new Uint8Array(require('fs').readFileSync(process.argv[1])))"
        ".then(report => console.log(JSON.stringify(report.issues)))"
    )
    for options in ((), ("--fit", "on"), ("--mesh", "none")):
        done = subprocess.run(["node", "-e", script, track(*options)[0]], cwd=folder, capture_output=True, text=True)
        issues = json.loads(done.stdout)
        assert (issues["numErrors"], issues["numWarnings"]) == (0, 0), issues["messages"]


def test_blender_imports_the_motion(track):
    reason = pypi.find_blender()
    if reason is not None:
        pytest.skip(reason)
    path, frames = track()
    seen = frames[::5]
    times = [frame["time_s"] - frames[0]["time_s"] for frame in seen]
    script = pathlib.Path(__file__).with_name("blender_bones.py")
    done = subprocess.run(
        [sys.executable, script, path, json.dumps(times), json.dumps(list(BONES))],
        env=dict(os.environ, PYTHONPATH=str(pypi.blender_folder() / "site")), capture_output=True, text=True, check=True,
    )  # fmt: skip
    found = json.loads(done.stdout.splitlines()[-1])
    assert found["vertices"] > 1500
    for frame, places in zip(seen, found["places"]):
        for bone, joint in BONES.items():
            x, y, z = frame["bodies"][0]["joints"][joint]["p"]
            # Blender's curves are quadratic between keys of other moments than its frames.
            assert np.linalg.norm(np.array(places[bone]) - (x, -z, y)) < 0.005, (bone, frame["frame"])


@pytest.mark.parametrize("options, expected", [
    (("--bvh-names", "sdk"), "expected vrm, cmu or mixamo"),
    (("--mesh", "absent.ossamesh"), "absent.ossamesh"),
])  # fmt: skip
def test_impossible_options_are_refused(options, expected, command, clip, tmp_path):
    with pytest.raises(subprocess.CalledProcessError) as refused:
        command("track", clip, "--out", tmp_path / "x.glb", "--quiet", *options)
    assert expected in refused.value.stderr
    assert not list(tmp_path.iterdir())


def test_unknown_names_are_refused_in_python(frames, tmp_path):
    sequence = ossa.Sequence.from_frames(frames[:3])
    for name, names in (("x.glb", "sdk"), ("x.jsonl", "vrm"), ("x.bvh", "unity")):
        with pytest.raises(ossa.InputError, match="names"):
            ossa.write_skeletons(sequence, tmp_path / name, names=names)
