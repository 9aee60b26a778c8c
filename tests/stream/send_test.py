"""`ossa track --send`: what an independent OSC library makes of it."""
import math
import socket
import subprocess
import time
import unittest

import receivers
from receivers import BUILD, SOURCE, WORK, cross, frames_of, messages, multiply, rotate, room_of, track, unit

ONE = SOURCE / "tests" / "golden" / "clips" / "one"
MOST_M = 0.001

# Unity's bone -> its parent, the joint where it is, the joint it points to in a T-pose and where that is.
LEFT, RIGHT, UP, DOWN, FORWARD = (-1, 0, 0), (1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1)
BONES = {
    "Hips": (None, "HipCenter", None, None), "Spine": ("Hips", "HipCenter", "Spine", UP),
    "Chest": ("Spine", "Spine", "ShoulderCenter", UP), "Neck": ("Chest", "ShoulderCenter", "Head", UP),
    "Head": ("Neck", "Head", None, None),
}
for side, out in (("Left", LEFT), ("Right", RIGHT)):
    BONES |= {
        side + "Shoulder": ("Chest", "ShoulderCenter", "Shoulder" + side, out),
        side + "UpperArm": (side + "Shoulder", "Shoulder" + side, "Elbow" + side, out),
        side + "LowerArm": (side + "UpperArm", "Elbow" + side, "Wrist" + side, out),
        side + "Hand": (side + "LowerArm", "Wrist" + side, "Hand" + side, out),
        side + "UpperLeg": ("Hips", "Hip" + side, "Knee" + side, DOWN),
        side + "LowerLeg": (side + "UpperLeg", "Knee" + side, "Ankle" + side, DOWN),
        side + "Foot": (side + "LowerLeg", "Ankle" + side, "Foot" + side, FORWARD),
        side + "Toes": (side + "Foot", "Foot" + side, None, None),
    }


def rebuilt(packet):
    """Bone -> place and rotation in the room, as a receiver's hierarchy of transforms has them; and the time."""
    local, time_s = {}, None
    for address, values in packet:
        if address == "/VMC/Ext/Bone/Pos":
            local[values[0]] = (values[1:4], values[4:8])
        elif address == "/VMC/Ext/T":
            time_s = values[0]
    root = next(v for a, v in packet if a == "/VMC/Ext/Root/Pos")
    world = {None: (tuple(root[1:4]), tuple(root[4:8]))}
    for bone, (parent, *_) in BONES.items():
        place, turn = world[parent]
        offset = rotate(turn, local[bone][0])
        world[bone] = (tuple(a + b for a, b in zip(place, offset)), multiply(turn, local[bone][1]))
    return world, time_s


def joints_in(room, body):
    return {name: room(joint["p"]) for name, joint in body["joints"].items()}


class OnePerson(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        vmc, vrchat, lines = receivers.Receiver(), receivers.Receiver(), receivers.Receiver()
        out = WORK / "one.jsonl"
        track(ONE, out, f"vmc://127.0.0.1:{vmc.port}", f"vrchat://127.0.0.1:{vrchat.port}?scale=1.25",
              f"udp://127.0.0.1:{lines.port}")
        cls.text = out.read_text().splitlines()
        cls.frames = frames_of(out)
        cls.rooms = room_of(cls.frames)
        cls.vmc, cls.vrchat, cls.lines = (r.finish()[0] for r in (vmc, vrchat, lines))

    def moments(self, datagrams):
        self.assertEqual(len(datagrams), len(self.frames))
        for datagram, frame, room in zip(datagrams, self.frames, self.rooms):
            yield messages(datagram), frame, joints_in(room, frame["bodies"][0])

    def test_vmc_sends_availability_and_time(self):
        for packet, frame, _ in self.moments(self.vmc):
            self.assertIn(("/VMC/Ext/OK", [1]), packet)
            self.assertAlmostEqual(rebuilt(packet)[1], frame["time_s"], places=4)

    def test_vmc_bones_are_at_the_joints(self):
        for packet, _, joints in self.moments(self.vmc):
            world, _ = rebuilt(packet)
            for bone, (_, joint, _, _) in BONES.items():
                self.assertLess(math.dist(world[bone][0], joints[joint]), MOST_M, bone)

    def test_vmc_sends_every_bone_of_the_unity_humanoid(self):
        """55 of HumanBodyBones: what is not seen is at rest, as long as the person's hands and head are."""
        for packet, _, joints in self.moments(self.vmc):
            bones = {v[0]: v[1:] for a, v in packet if a == "/VMC/Ext/Bone/Pos"}
            self.assertEqual(len(bones), 55)
            fingers = {f"{s}{f}{p}" for s in ("Left", "Right") for f in ("Thumb", "Index", "Middle", "Ring", "Little")
                       for p in ("Proximal", "Intermediate", "Distal")}
            rest = fingers | {"UpperChest", "LeftEye", "RightEye", "Jaw"}
            self.assertEqual(set(bones) - set(BONES), rest)
            self.assertTrue(all(bones[name][3:] == [0, 0, 0, 1] for name in rest))
            self.assertEqual(bones["UpperChest"][:3], [0, 0, 0])  # the neck's place is told from the chest
            forearm = math.dist(joints["ElbowLeft"], joints["WristLeft"])
            knuckle = bones["LeftMiddleProximal"][:3]
            self.assertTrue(0.3 * forearm < -knuckle[0] < 0.5 * forearm, (knuckle, forearm))
            self.assertLess(bones["LeftThumbProximal"][0], 0)
            self.assertGreater(bones["RightThumbProximal"][0], 0)
            self.assertGreater(bones["LeftThumbProximal"][2], 0)  # palms are down, thumbs forwards

    def test_vmc_can_leave_out_unseen_bones(self):
        vmc = receivers.Receiver()
        track(ONE, WORK / "seen.jsonl", f"vmc://127.0.0.1:{vmc.port}?bones=seen")
        for datagram in vmc.finish()[0]:
            self.assertEqual({v[0] for a, v in messages(datagram) if a == "/VMC/Ext/Bone/Pos"}, set(BONES))

    def test_vmc_rotations_alone_reproduce_the_pose(self):
        for packet, _, joints in self.moments(self.vmc):
            world, _ = rebuilt(packet)
            for bone, (_, begin, end, rest) in BONES.items():
                if end is None:
                    continue
                along = unit([b - a for a, b in zip(joints[begin], joints[end])])
                self.assertLess(math.dist(rotate(world[bone][1], rest), along), 0.01, bone)

    def test_person_facing_the_sensor_faces_forwards(self):
        """Left is -x of the body's own frame, and the feet point to +z of it: Unity's left-handed axes."""
        for packet, _, joints in self.moments(self.vmc):
            world, _ = rebuilt(packet)
            left = [a - b for a, b in zip(joints["HipLeft"], joints["HipRight"])]
            front = rotate(world["Hips"][1], FORWARD)
            self.assertLess(math.dist(rotate(world["Hips"][1], LEFT), unit(left)), 0.05)
            self.assertGreater(front[2], 0)
            # In a left-handed frame right x up = -forward of the right-handed product.
            self.assertGreater(sum(a * b for a, b in zip(cross([-c for c in left], UP), front)), 0)

    def test_floor_is_at_zero_height(self):
        feet = [joints[name][1] for _, frame, joints in self.moments(self.vmc) for name in ("FootLeft", "FootRight")
                if frame["bodies"][0]["joints"][name]["state"] == "tracked"]
        self.assertGreater(len(feet), 5)
        self.assertTrue(all(-0.1 < y < 0.15 for y in feet), feet)

    def test_vrchat_receives_eight_scaled_trackers_and_the_head(self):
        places = {"1": "HipCenter", "2": "Spine", "3": "AnkleLeft", "4": "AnkleRight", "5": "KneeLeft",
                  "6": "KneeRight", "7": "ElbowLeft", "8": "ElbowRight", "head": "Head"}
        for packet, _, joints in self.moments(self.vrchat):
            packet = dict(packet)
            self.assertEqual(len(packet), 2 * len(places))
            for tracker, joint in places.items():
                place = packet[f"/tracking/trackers/{tracker}/position"]
                self.assertLess(math.dist(place, [1.25 * c for c in joints[joint]]), 1.25 * MOST_M)

    def test_vrchat_angles_reproduce_the_pose(self):
        turned = {"5": "LeftLowerLeg", "6": "RightLowerLeg", "7": "LeftLowerArm", "8": "RightLowerArm"}
        for packet, _, joints in self.moments(self.vrchat):
            packet = dict(packet)
            for tracker, bone in turned.items():
                _, begin, end, rest = BONES[bone]
                along = unit([b - a for a, b in zip(joints[begin], joints[end])])
                self.assertLess(math.dist(by_euler(packet[f"/tracking/trackers/{tracker}/rotation"], rest), along), 0.01)

    def test_udp_datagram_is_a_line_of_the_skeleton_file(self):
        self.assertEqual([d.decode() for d in self.lines], self.text)


def by_euler(degrees, v):
    """Unity's order: about z, then x, then y."""
    for axis in (2, 0, 1):
        half = math.radians(degrees[axis]) / 2
        q = [0.0, 0.0, 0.0, math.cos(half)]
        q[axis] = math.sin(half)
        v = rotate(q, v)
    return v


def two_people():
    """A clip of two people in a room who are both in view: seeds differ in that."""
    clip = WORK / "two_people"
    subprocess.run([BUILD / "bin" / "ossa", "render", "--mocap", "authored", "--out", clip, "--sequence", "--people", "2",
                    "--seed", "11", "--split", "test", "--size", "320x240", "--frames", "10", "--quiet"], check=True)
    return clip


class Sending(unittest.TestCase):
    def test_every_person_has_their_own_port(self):
        vmc, out = receivers.Receiver(3), WORK / "two.jsonl"
        track(two_people(), out, f"vmc://127.0.0.1:{vmc.port}")
        first, second, third = vmc.finish()
        frames = frames_of(out)
        rooms = room_of(frames)
        self.assertEqual(third, [])
        ids = sorted({body["id"] for frame in frames for body in frame["bodies"]})
        self.assertEqual(ids, [1, 2])
        for datagrams, body_id in zip((first, second), ids):
            seen = [(room, body) for room, frame in zip(rooms, frames) for body in frame["bodies"]
                    if body["id"] == body_id]
            self.assertEqual(len(datagrams), len(seen))
            for datagram, (room, body) in zip(datagrams, seen):
                hips = rebuilt(messages(datagram))[0]["Hips"][0]
                self.assertLess(math.dist(hips, room(body["joints"]["HipCenter"]["p"])), MOST_M)

    def test_absent_receiver_does_not_slow_tracking(self):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
            free.bind(("127.0.0.1", 0))
            port = free.getsockname()[1]
        alone, sent = WORK / "alone.jsonl", WORK / "sent.jsonl"
        track(ONE, alone)
        began = time.monotonic()
        track(ONE, sent, f"vmc://127.0.0.1:{port}", f"udp://127.0.0.1:{port}", f"vrchat://[::1]:{port}")
        self.assertLess(time.monotonic() - began, 60)
        self.assertEqual(sent.read_bytes(), alone.read_bytes())

    def test_invalid_targets_are_refused(self):
        for wrong in ("udp://127.0.0.1", "vmc://:1", "tcp://h:1", "vmc://h:70000", "vrchat://h?scale=0", "vmc://h?scale=2",
                      "vrchat://h?bones=all", "vmc://h?bones=some"):
            self.assertIn(f"--send {wrong}: expected", track(ONE, WORK / "x.jsonl", wrong, expect=2).stderr)
        self.assertIn("expected a host", track(ONE, WORK / "x.jsonl", "udp://no-such-host.invalid:1", expect=1).stderr)


if __name__ == "__main__":
    receivers.main()
