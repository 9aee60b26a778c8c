"""`--bvh-names`: humanoids as readers that are not ours see them, PyPI's `bvh` and, with `blender` as first argument,
Blender's own importer of PyPI's `bpy` (tests/support/pypi.py fetches it; skipped where it is not there)."""
import math
import subprocess
import sys
import unittest

import receivers
from receivers import BUILD, SOURCE, WORK, frames_of
from bvh import Bvh

ONE = SOURCE / "tests" / "golden" / "clips" / "one"
# The joint where a bone of the humanoid begins.
PLACES = {"Hips": "HipCenter", "Spine1": "Spine", "Head": "Head"}
VRM = {"Hips": "hips", "Spine": "spine", "Spine1": "chest", "Neck": "neck", "Head": "head"}
for side in ("Left", "Right"):
    for name, joint, vrm in (("Arm", "Shoulder", "UpperArm"), ("ForeArm", "Elbow", "LowerArm"), ("Hand", "Wrist", "Hand"),
                             ("UpLeg", "Hip", "UpperLeg"), ("Leg", "Knee", "LowerLeg"), ("Foot", "Ankle", "Foot"),
                             ("ToeBase", "Foot", "Toes")):
        PLACES[side + name] = joint + side
        VRM[side + name] = side.lower() + vrm
NAMES = {"cmu": lambda n: n, "mixamo": lambda n: "mixamorig:" + n, "vrm": VRM.get}
# Constant bones against those of each frame, and hips that are one piece.
MOST_M = 0.03


def write(names):
    out = WORK / f"{names}.bvh"
    subprocess.run([BUILD / "bin" / "ossa", "track", ONE, "--out", out, "--bvh-names", names, "--quiet"], check=True)
    return out


def matrix(axis, degrees):
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    rows = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
    i, j = [k for k in range(3) if k != axis]
    if axis == 1:
        i, j = j, i
    rows[i][i], rows[i][j], rows[j][i], rows[j][j] = c, -s, s, c
    return rows


def product(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(3)) for j in range(3)] for i in range(3)]


def apply(a, v):
    return [sum(a[i][k] * v[k] for k in range(3)) for i in range(3)]


def places_in(motion, frame):
    """Joint -> metres, by forward kinematics."""
    world = {}
    for name in motion.get_joints_names():
        channels = motion.joint_channels(name)
        values = dict(zip(channels, motion.frame_joint_channels(frame, name, channels)))
        offset, turn = list(motion.joint_offset(name)), [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
        if "Xposition" in values:
            offset = [values[axis + "position"] for axis in "XYZ"]
        for channel in channels:
            if channel.endswith("rotation"):
                turn = product(turn, matrix("XYZ".index(channel[0]), values[channel]))
        parent = motion.joint_parent(name)
        if parent is not None:
            place, carried = world[parent.name]
            offset = [a + b for a, b in zip(place, apply(carried, offset))]
            turn = product(carried, turn)
        world[name] = (offset, turn)
    return {name: [c / 100 for c in place] for name, (place, _) in world.items()}


class Names(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        out = WORK / "one.jsonl"
        subprocess.run([BUILD / "bin" / "ossa", "track", ONE, "--out", out, "--quiet"], check=True)
        cls.frames = frames_of(out)

    def truth(self, frame):
        return {name: joint["p"] for name, joint in frame["bodies"][0]["joints"].items()}

    def test_independent_reader_gets_the_joint_positions(self):
        for names, name_of in NAMES.items():
            motion = Bvh(write(names).read_text())
            self.assertEqual(motion.nframes, len(self.frames))
            for i, frame in enumerate(self.frames):
                places, truth = places_in(motion, i), self.truth(frame)
                for bone, joint in PLACES.items():
                    self.assertLess(math.dist(places[name_of(bone)], truth[joint]), MOST_M, (names, bone))

    def test_rest_pose_is_a_t_pose_with_the_left_at_plus_x(self):
        motion = Bvh(write("cmu").read_text())
        for bone, axis, sign in (("LeftForeArm", 0, 1), ("RightForeArm", 0, -1), ("LeftLeg", 1, -1), ("Head", 1, 1),
                                 ("LeftToeBase", 2, 1)):
            offset = motion.joint_offset(bone)
            self.assertGreater(sign * offset[axis], 0.99 * math.hypot(*offset), bone)

    def test_ossa_reads_them_back(self):
        for names in NAMES:
            table = subprocess.run([BUILD / "bin" / "ossa", "compare", WORK / "one.jsonl", write(names)], check=True,
                                   capture_output=True, text=True).stdout
            error_cm = next(line for line in table.splitlines() if "mean error cm" in line).split("|")[2]
            self.assertLess(float(error_cm), 1.5)

    def test_names_are_refused_for_formats_other_than_bvh(self):
        result = subprocess.run([BUILD / "bin" / "ossa", "track", ONE, "--out", WORK / "x.jsonl", "--bvh-names", "vrm"],
                                capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 2)
        self.assertIn("expected --out FILE.bvh", result.stderr)


class Blender(Names):
    """The same through Blender: z up, -y forwards."""

    def test_independent_reader_gets_the_joint_positions(self):
        for names, name_of in NAMES.items():
            bpy.ops.wm.read_factory_settings(use_empty=True)
            bpy.ops.import_anim.bvh(filepath=str(write(names)), global_scale=0.01, update_scene_fps=True)
            armature = bpy.context.object
            self.assertEqual(len(armature.data.bones), 21)
            for i, frame in enumerate(self.frames):
                bpy.context.scene.frame_set(i + 1)
                truth = self.truth(frame)
                for bone, joint in PLACES.items():
                    place = armature.matrix_world @ armature.pose.bones[name_of(bone)].head
                    x, y, z = truth[joint]
                    self.assertLess(math.dist(place, (x, -z, y)), MOST_M, (names, bone))


if __name__ == "__main__":
    if sys.argv[1:2] == ["blender"]:
        del sys.argv[1]
        reason = receivers.pypi.find_blender()
        if reason is not None:
            print(f"SKIPPED: {reason}")
            sys.exit(receivers.pypi.SKIPPED)
        import bpy
    else:
        del Blender
    receivers.main()
