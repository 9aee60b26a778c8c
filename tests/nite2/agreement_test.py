"""libNiTE2.so and ossa's own tracker for the same depth images: two people and a floor, through the PyPI package
`openni` and through the Python package `ossa`."""
import math
import subprocess
import sys
import unittest

import clients
from clients import PLACES
from openni import nite2

try:
    import numpy

    sys.path.insert(0, str(clients.BUILD / "python"))
    import ossa
except ImportError as missing:
    print(f"SKIPPED: {missing}: the build's Python package and NumPy are needed")
    sys.exit(77)

WIDTH, HEIGHT, FRAMES = 320, 240, 20
CONFIDENCE = {"tracked": 1.0, "inferred": 0.5, "not_tracked": 0.0}
NEW = 3
MOST_MM = 0.001  # floats of a few metres
MOST_PIXELS = 1e-4


def two_people():
    """A clip of two people in a room: seeds differ in who is hidden."""
    clip = clients.WORK / "two_people"
    subprocess.run([clients.BUILD / "bin" / "ossa", "render", "--mocap", "authored", "--out", clip, "--sequence",
                    "--people", "2", "--seed", "11", "--split", "test", "--size", f"{WIDTH}x{HEIGHT}", "--frames",
                    str(FRAMES), "--quiet"], check=True)
    return clip


def millimetres(point):
    """NiTE's point in camera space: x to the sensor's left."""
    return numpy.array([-point.x, point.y, point.z])


def camera_of(device):
    """The pinhole camera by OpenNI2's fields of view, which all its conversions use."""
    stream = device.create_depth_stream()
    focal = [size / 2 / math.tan(angle / 2)
             for size, angle in ((WIDTH, stream.get_horizontal_fov()), (HEIGHT, stream.get_vertical_fov()))]
    stream.close()
    return ossa.Camera(*focal, WIDTH / 2, HEIGHT / 2, width=WIDTH, height=HEIGHT)


class User:
    """A copy of a user, which is valid only until its frame is closed."""

    def __init__(self, user, tracker):
        self.id, self.state = user.id, int(user.state)
        self.centre_mm = millimetres(user.centerOfMass)
        self.has_skeleton = int(user.skeleton.state) != 0
        joints = [user.skeleton.joints[j] for j in PLACES]
        self.joints_mm = numpy.array([millimetres(joint.position) for joint in joints])
        self.confidence = [joint.positionConfidence for joint in joints]
        self.pixels = [tracker.convert_joint_coordinates_to_depth(p.x, p.y, p.z)
                       for p in (joint.position for joint in joints)] if self.has_skeleton else []


class Moment:
    def __init__(self, frame, tracker):
        self.number, self.time_s = frame.frameIndex, frame.timestamp * 1e-6
        self.users = [User(user, tracker) for user in frame.users]
        self.map = numpy.array(frame.userMap.pixels[:WIDTH * HEIGHT]).reshape(HEIGHT, WIDTH)
        self.floor_confidence = frame.floorConfidence
        self.floor_point_mm = millimetres(frame.floor.point)
        self.floor_normal = millimetres(frame.floor.normal)


class Agreement(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        clients.start()
        cls.addClassCleanup(clients.stop)
        clip = two_people()
        device = clients.camera(clip, "?speed=0.2")
        cls.camera = camera_of(device)
        cls.moments = cls.play(nite2.UserTracker(device))
        images = [depth_mm for depth_mm, _, _ in ossa.open(clip)]
        cls.frames = cls.track(images)

    @classmethod
    def play(cls, tracker):
        moments = []
        while True:
            try:
                frame = tracker.read_frame()
            except clients.NiteError:
                return moments  # the clip's end: the camera is unplugged
            moments.append(Moment(frame, tracker))
            for user in moments[-1].users:
                if user.state == NEW:
                    tracker.start_skeleton_tracking(user.id)
            frame.close()

    @classmethod
    def track(cls, images):
        """The images that arrived, with a skeleton of those for whom one was asked."""
        tracker, asked, frames = ossa.Tracker(), [], []
        for moment in cls.moments:
            tracker.choose_users(asked)
            frames.append(tracker.track(images[moment.number], cls.camera, moment.time_s))
            asked += [user.id for user in moment.users if user.state == NEW]
        return frames

    def people(self):
        """User and body, each of a frame; ids are equal as long as nobody has left."""
        for moment, frame in zip(self.moments, self.frames):
            self.assertEqual([user.id for user in moment.users], [body.id for body in frame.bodies])
            yield from zip(moment.users, frame.bodies)

    def test_both_people_have_skeletons(self):
        self.assertEqual({body.id for _, body in self.people() if body.tracked}, {1, 2})

    def test_joints_and_centres_are_the_same_in_millimetres(self):
        for user, body in self.people():
            self.assertLess(numpy.abs(user.centre_mm - 1000 * body.position).max(), MOST_MM)
            self.assertEqual(user.has_skeleton, body.tracked)
            if body.tracked:
                joints_m = numpy.array([body[name] for name in PLACES.values()])
                self.assertLess(numpy.abs(user.joints_mm - 1000 * joints_m).max(), MOST_MM)

    def test_confidences_are_those_of_the_states(self):
        for user, body in self.people():
            if body.tracked:
                self.assertEqual(user.confidence,
                                 [CONFIDENCE[body.states[ossa.JOINTS.index(name)]] for name in PLACES.values()])

    def test_joints_are_converted_to_their_pixels(self):
        for user, body in self.people():
            for (u, v), name in zip(user.pixels, PLACES.values()):
                x, y, z = body[name]
                self.assertAlmostEqual(u, self.camera.cx - self.camera.fx * x / z, delta=MOST_PIXELS)
                self.assertAlmostEqual(v, self.camera.cy - self.camera.fy * y / z, delta=MOST_PIXELS)

    def test_user_map_is_the_same(self):
        for moment, frame in zip(self.moments, self.frames):
            self.assertTrue((moment.map == frame.users).all())

    def test_floor_is_the_same_plane(self):
        for moment, frame in zip(self.moments, self.frames):
            self.assertEqual(moment.floor_confidence, 0 if frame.floor is None else 1)
            self.assertIsNotNone(frame.floor)
            self.assertLess(numpy.abs(moment.floor_normal - frame.floor[:3]).max(), 1e-6)
            height_m = frame.floor[:3] @ moment.floor_point_mm / 1000 + frame.floor[3]
            self.assertAlmostEqual(height_m, 0, delta=MOST_MM / 1000)


if __name__ == "__main__":
    clients.main()
