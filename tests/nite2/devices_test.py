"""libNiTE2.so on devices in the modes that programs set, and its misuse; the client is the PyPI package `openni`."""
import ctypes
import pathlib
import re
import subprocess
import sys
import threading
import time
import unittest

import clients
from clients import PLACES, distance, place
from openni import _nite2, nite2, openni2

NEW, TRACKED = 3, 2
BAD_USER_ID = 2


def status_of(call, *arguments):
    """The status of a function of the C interface; the package turns errors into exceptions."""
    try:
        return int(call(*arguments))
    except clients.NiteError as error:
        return int(error.args[0])


# A busy machine delivers few of a camera's frames: as many skeletons are waited for, at most so many seconds.
ENOUGH, PATIENCE_S = 10, 60


def track(device, seconds=1.5):
    """Frames of whoever is there, with a skeleton: (frame index, joints in NiTE's millimetres)."""
    tracker, seen = nite2.UserTracker(device), []
    began = time.monotonic()
    while (time_s := time.monotonic() - began) < seconds or (len(seen) < ENOUGH and time_s < PATIENCE_S):
        frame = tracker.read_frame()
        for user in frame.users:
            if user.is_new():
                tracker.start_skeleton_tracking(user.id)
            if user.skeleton.state == TRACKED:
                seen.append((frame.frameIndex, [place_of(j) for j in user.skeleton.joints]))
        frame.close()
    tracker.close()
    return seen


def place_of(joint):
    return nite2.Point3f(joint.position.x, joint.position.y, joint.position.z)


class WithAClip(unittest.TestCase):
    """The package is started, and there is a clip by these arguments of make_clip."""

    CLIP = ("asking",)

    @classmethod
    def setUpClass(cls):
        clients.start()
        cls.addClassCleanup(clients.stop)
        cls.clip = clients.make_clip(*cls.CLIP)


class Devices(WithAClip):
    CLIP = ("large", "640x480")

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.truth = clients.truth_of(cls.clip)

    def check_left_is_left(self, seen, mirrored=False, truth=None):
        truth = truth or self.truth
        errors = [distance(place(joints[j], mirrored), truth[frame % len(truth)][name])
                  for frame, joints in seen for j, name in PLACES.items()]
        self.assertGreater(len(seen), 5)
        self.assertLess(sum(errors) / len(errors), 0.05)

    def test_joints_match_unmirrored_images(self):
        self.check_left_is_left(track(clients.camera(self.clip, "?loop=1")))

    def test_joints_match_images_mirrored_by_default(self):
        self.check_left_is_left(track(clients.camera(self.clip, "?loop=1&mirror=1")), mirrored=True)

    def test_joints_match_images_mirrored_by_the_program(self):
        device = clients.camera(self.clip, "?loop=1&speed=1.0")
        stream = device.create_depth_stream()
        stream.set_mirroring_enabled(True)
        stream.start()
        self.check_left_is_left(track(device), mirrored=True)
        stream.close()

    def test_joints_match_images_of_half_the_size(self):
        device = clients.camera(self.clip, "?loop=1&fps=30")
        stream = device.create_depth_stream()
        stream.set_video_mode(openni2.c_api.OniVideoMode(
            pixelFormat=openni2.PIXEL_FORMAT_DEPTH_1_MM, resolutionX=320, resolutionY=240, fps=30))
        stream.start()
        tracker = nite2.UserTracker(device)
        frame = tracker.read_frame()
        self.assertEqual((frame.userMap.width, frame.userMap.height), (320, 240))
        x, y = tracker.convert_depth_coordinates_to_joint(160, 120, 2000)
        self.assertEqual((round(x), round(y)), (0, 0))
        frame.close()
        tracker.close()
        self.check_left_is_left(track(device))
        stream.close()

    def test_conversions_are_inverses(self):
        tracker = nite2.UserTracker(clients.camera(self.clip, "?loop=1&speed=1.1"))
        x, y = tracker.convert_depth_coordinates_to_joint(500, 100, 2500)
        self.assertGreater(x, 0)  # right of the middle
        self.assertGreater(y, 0)  # above it
        u, v = tracker.convert_joint_coordinates_to_depth(x, y, 2500)
        self.assertAlmostEqual(u, 500, places=1)
        self.assertAlmostEqual(v, 100, places=1)
        self.assertNotEqual(status_of(_nite2.niteConvertJointCoordinatesToDepth, tracker._handle, 0.0, 0.0, 0.0,
                                      ctypes.byref(ctypes.c_float()), ctypes.byref(ctypes.c_float())), 0)
        tracker.close()
        hands = nite2.HandTracker(clients.camera(self.clip, "?loop=1&speed=1.1"))
        x, y = hands.convert_depth_coordinates_to_hand(500, 100, 2500)
        self.assertAlmostEqual(hands.convert_hand_coordinates_to_depth(x, y, 2500)[0], 500, places=1)
        hands.close()

    def test_recording_is_played(self):
        recording = clients.WORK / "short.oni"
        subprocess.run([clients.BUILD / "bin" / "ossa", "record", self.clip, "--out", recording, "--quiet"], check=True)
        seen = track(openni2.Device(str(recording).encode()))
        self.assertGreater(len(seen), 5)
        self.assertTrue(all(joints[4].x > joints[5].x for _, joints in seen), "the left elbow is on the image's right")

    def test_first_device_is_opened_by_default(self):
        code = ("import os; os.environ['OSSA_VIRTUAL_DEVICE'] = 'ossa://%s?loop=1'\n" % self.clip +
                "import clients, openni.nite2 as n\nclients.start()\nt = n.UserTracker.open_any()\n"
                "h = n.HandTracker.open_any()\nprint(t.read_frame().userMap.width, len(h.read_frame().hands))\n"
                "clients.stop()")
        self.assertEqual(run_python(code).stdout, "640 0\n")

    def test_two_trackers_run_on_two_devices(self):
        small = clients.make_clip("small", seed=2)
        devices = [clients.camera(self.clip, "?loop=1&speed=1.2"), clients.camera(small, "?loop=1&speed=1.2")]
        trackers = [nite2.UserTracker(device) for device in devices]
        for _ in range(5):
            frames = [tracker.read_frame() for tracker in trackers]
            self.assertEqual([f.userMap.width for f in frames], [640, 320])
            for frame in frames:
                frame.close()
        for tracker in trackers:
            tracker.close()

    def test_kinect_registers_depth_to_its_colour_camera(self):
        fakenect, dump = "/usr/lib/x86_64-linux-gnu/fakenect", clients.WORK / "dump"
        if not clients.pathlib.Path(fakenect).is_dir():
            self.skipTest("no fakenect: " + fakenect)
        subprocess.run([clients.BUILD / "bin" / "ossa", "record", self.clip, "--out", dump, "--fakenect", "--quiet"],
                       check=True)
        code = ("import clients, devices_test as d\nfrom openni import openni2\nclients.start()\n"
                "device = openni2.Device(b'freenect://0')\n"
                "device.set_image_registration_mode(openni2.c_api.OniImageRegistrationMode."
                "ONI_IMAGE_REGISTRATION_DEPTH_TO_COLOR)\n"
                "assert int(device.get_image_registration_mode()) == 1\n"
                "import openni.nite2 as n\nstream = device.create_depth_stream()\n"
                "stream.set_mirroring_enabled(False)\nseen = d.track(device, 3)\n"
                "print(len(seen) > 5 and all(j[4].x > j[5].x for _, j in seen))\nclients.stop()")
        result = run_python(code, LD_LIBRARY_PATH=fakenect, FAKENECT_PATH=str(dump))
        self.assertEqual(result.stdout, "True\n", result.stderr)


class Functions(WithAClip):
    """The functions of a tracker beside its frames."""

    def setUp(self):
        self.device = clients.camera(self.clip, "?loop=1")
        self.tracker = nite2.UserTracker(self.device)
        self.addCleanup(self.tracker.close)

    def user(self):
        for _ in range(60):
            frame = self.tracker.read_frame()
            users = [(u.id, int(u.skeleton.state), [int(p.state) for p in u.poses],
                      [place_of(j) for j in u.skeleton.joints]) for u in frame.users]
            frame.close()
            if users:
                return users[0]
        return self.fail("nobody is seen")

    def test_version_is_that_of_the_interface(self):
        version = nite2.get_version()
        self.assertEqual((version.major, version.minor), (2, 2))

    def test_a_skeleton_is_tracked_from_start_to_stop(self):
        user = self.user()[0]
        self.tracker.start_skeleton_tracking(user)
        self.assertTrue(_nite2.niteIsSkeletonTracking(self.tracker._handle, user))
        self.assertEqual([self.user()[1] for _ in range(4)], [1, 2, 2, 2])
        self.tracker.stop_skeleton_tracking(user)
        self.assertFalse(_nite2.niteIsSkeletonTracking(self.tracker._handle, user))
        self.assertEqual(self.user()[1], 0)

    def test_pose_detection_stops_one_by_one_and_all_at_once(self):
        user = self.user()[0]
        for pose in (0, 1):
            self.tracker.start_pose_detection(user, pose)
        self.assertEqual(self.user()[2], [1, 1])
        self.tracker.stop_pose_detection(user, 0)
        self.assertEqual(self.user()[2], [0, 1])
        self.tracker.stop_all_pose_detection(user)
        self.assertEqual(self.user()[2], [0, 0])

    def test_absent_users_are_refused(self):
        self.assertEqual(status_of(_nite2.niteStartSkeletonTracking, self.tracker._handle, 7), BAD_USER_ID)
        self.assertEqual(status_of(_nite2.niteStartPoseDetection, self.tracker._handle, 7, 0), BAD_USER_ID)

    def test_smoothing_is_clamped_to_0_and_1(self):
        self.tracker.skeleton_smoothing_factor = 0.75
        self.assertEqual(self.tracker.skeleton_smoothing_factor, 0.75)
        for wrong in (-0.1, 1.1, float("nan")):
            self.assertNotEqual(status_of(_nite2.niteSetSkeletonSmoothing, self.tracker._handle, wrong), 0)
        self.assertEqual(self.tracker.skeleton_smoothing_factor, 0.75)

    def test_full_smoothing_freezes_joints(self):
        self.tracker.start_skeleton_tracking(self.user()[0])
        while self.user()[1] != TRACKED:
            pass
        self.tracker.skeleton_smoothing_factor = 1.0
        first = self.user()[3][7]
        for _ in range(30):
            last = self.user()[3][7]
        self.assertEqual((first.x, first.y, first.z), (last.x, last.y, last.z))

    def test_hand_tracking_and_gestures_start_and_stop(self):
        hands = nite2.HandTracker(self.device)
        hands.smoothing_factor = 0.25
        self.assertEqual(hands.smoothing_factor, 0.25)
        first = hands.start_hand_tracking(0.0, 0.0, 1.0).value  # nobody's hand is there
        second = hands.start_hand_tracking(0.0, 0.0, 1.0).value
        self.assertEqual([first, second], [1, 2])
        hands.stop_hand_tracking(first)
        self.assertEqual([(h.id, int(h.state)) for h in hands.read_frame().hands], [(second, 0)])
        hands.start_hand_tracking(0.0, 0.0, 1.0)
        hands.stop_all_hand_tracking()
        hands.start_gesture_detection(2)
        hands.stop_gesture_detection(2)
        hands.start_gesture_detection(0)
        hands.stop_all_gesture_detection()
        for _ in range(60):  # in which the clip raises a hand
            frame = hands.read_frame()
            self.assertEqual((len(frame.hands), len(frame.gestures)), (0, 0))
            frame.close()
        hands.close()

    def test_listeners_are_called_until_they_are_removed(self):
        for tracker, listener in ((self.tracker, nite2.UserTrackerListener),
                                  (nite2.HandTracker(self.device), nite2.HandTrackerListener)):
            told = []

            class Listener(listener):
                def on_ready_for_next_frame(self):
                    frame = tracker.read_frame()  # noqa: B023
                    told.append(frame.frameIndex)  # noqa: B023
                    frame.close()

            heard = Listener(tracker)
            wait_for(lambda: len(told) >= 5)  # noqa: B023
            heard.close()
            count = len(told)
            time.sleep(0.2)
            self.assertEqual(len(told), count)
            self.assertEqual(told, sorted(set(told)))
            if tracker is not self.tracker:
                tracker.close()


class Misuse(WithAClip):
    CLIP = ("misuse",)

    def test_every_function_of_the_package_is_exported_and_documented(self):
        declared = set(re.findall(r"\bnite[A-Z]\w+", pathlib.Path(_nite2.__file__).read_text()))
        table = set(re.findall(r"\bnite[A-Z]\w+", (clients.HERE.parents[1] / "docs" / "nite2.md").read_text()))
        self.assertEqual(len(declared), 39)
        self.assertEqual(declared - table, set())
        library = ctypes.CDLL(str(clients.BUILD / "lib" / "ossa" / "nite2" / "libNiTE2.so"))
        self.assertEqual([name for name in declared if not hasattr(library, name)], [])

    def test_library_loads_again_after_unloading(self):
        for _ in range(3):
            tracker = nite2.UserTracker(clients.camera(self.clip, "?loop=1"))
            self.assertEqual(tracker.read_frame().userMap.width, 320)
            clients.stop()
            clients.start()

    def test_frames_released_too_often_are_an_error(self):
        for tracker, read, release in (
                (nite2.UserTracker(clients.camera(self.clip, "?loop=1")), _nite2.niteReadUserTrackerFrame,
                 _nite2.niteUserTrackerFrameRelease),
                (nite2.HandTracker(clients.camera(self.clip, "?loop=1")), _nite2.niteReadHandTrackerFrame,
                 _nite2.niteHandTrackerFrameRelease)):
            kind = _nite2.NiteUserTrackerFrame if "User" in read.__name__ else _nite2.NiteHandTrackerFrame
            frame = ctypes.POINTER(kind)()
            read(tracker._handle, ctypes.byref(frame))
            other = ctypes.POINTER(kind)()
            self.assertEqual(status_of(release, tracker._handle, frame), 0)
            self.assertNotEqual(status_of(release, tracker._handle, frame), 0)
            read(tracker._handle, ctypes.byref(other))
            self.assertNotEqual(status_of(release, tracker._handle, frame), 0)
            self.assertEqual(status_of(release, tracker._handle, other), 0)
            tracker.close()

    def test_closed_trackers_and_null_are_errors(self):
        tracker = nite2.UserTracker(clients.camera(self.clip, "?loop=1"))
        handle = tracker._handle
        tracker.close()
        nothing = ctypes.cast(None, type(handle))
        frame = ctypes.POINTER(_nite2.NiteUserTrackerFrame)()
        for bad in (handle, nothing):
            self.assertNotEqual(status_of(_nite2.niteShutdownUserTracker, bad), 0)
            self.assertNotEqual(status_of(_nite2.niteReadUserTrackerFrame, bad, ctypes.byref(frame)), 0)
            self.assertNotEqual(status_of(_nite2.niteStartSkeletonTracking, bad, 1), 0)
            self.assertFalse(_nite2.niteIsSkeletonTracking(bad, 1))
            _nite2.niteStopSkeletonTracking(bad, 1)

    def test_unplugged_device_is_an_error_within_seconds(self):
        tracker = nite2.UserTracker(clients.camera(self.clip, "?unplug_after=10"))
        began = time.monotonic()
        with self.assertRaises(clients.NiteError):
            while True:
                tracker.read_frame().close()
        self.assertLess(time.monotonic() - began, 10)
        tracker.close()

    def test_camera_that_stops_delivering_is_an_error_within_seconds(self):
        tracker = nite2.UserTracker(clients.camera(self.clip, "?stall_after=5"))
        with self.assertRaises(clients.NiteError):
            while True:
                tracker.read_frame().close()
        tracker.close()

    def test_closing_in_another_thread_ends_the_wait(self):
        tracker = nite2.UserTracker(clients.camera(self.clip, "?stall_after=1"))
        handle, answers = tracker._handle, []

        def wait():
            frame = ctypes.POINTER(_nite2.NiteUserTrackerFrame)()
            answers.extend(status_of(_nite2.niteReadUserTrackerFrame, handle, ctypes.byref(frame)) for _ in range(3))

        waiting = threading.Thread(target=wait)
        waiting.start()
        time.sleep(0.3)
        tracker.close()
        waiting.join(timeout=10)
        self.assertFalse(waiting.is_alive())
        self.assertEqual(answers[-1], 1)

    def test_callback_may_close_its_tracker(self):
        tracker = nite2.UserTracker(clients.camera(self.clip, "?loop=1"))
        handle, closed = tracker._handle, []

        class Listener(nite2.UserTrackerListener):
            def on_ready_for_next_frame(self):
                closed.append(status_of(_nite2.niteShutdownUserTracker, handle))

        listener = Listener(tracker)
        wait_for(lambda: closed)
        self.assertEqual(closed[0], 0)
        listener.close()
        self.assertNotEqual(status_of(_nite2.niteShutdownUserTracker, handle), 0)

    def test_device_may_be_closed_before_the_tracker(self):
        device = clients.camera(self.clip, "?loop=1")
        tracker = nite2.UserTracker(device)
        device.close()
        self.assertEqual(tracker.read_frame().userMap.width, 320)
        tracker.close()

    def test_program_that_closes_nothing_exits_normally(self):
        code = ("import clients, openni.nite2 as n, os, sys\nclients.start()\n"
                "t = n.UserTracker(clients.camera('%s', '?loop=1'))\nf = t.read_frame()\n" % self.clip +
                "print(f.userMap.width)\nsys.stdout.flush()\n")
        for end in ("", "os._exit(0)", "import ctypes; ctypes.CDLL(None).exit(0)"):
            result = run_python(code + end)
            self.assertEqual((result.returncode, result.stdout), (0, "320\n"), result.stderr)

    def test_unreleased_frames_do_not_fill_the_memory(self):
        code = ("import clients, openni.nite2 as n, resource\nclients.start()\n"
                "t = n.UserTracker(clients.camera('%s', '?loop=1&speed=20'))\n" % self.clip +
                "peak = lambda: resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024\n"
                "for i in range(150): t.read_frame().close()\n"
                "first = peak()\n"
                "for i in range(450): t.read_frame().close()\n"
                "print(peak() - first < 60)\nclients.stop()")
        result = run_python(code)
        self.assertEqual(result.stdout, "True\n", result.stderr)

    def test_tracker_fails_to_open_without_a_device(self):
        code = "import clients, openni.nite2 as n\nclients.start()\nn.UserTracker.open_any()"
        self.assertIn("NiteError", run_python(code).stderr)


def wait_for(condition, seconds=20):
    end = time.monotonic() + seconds
    while not condition() and time.monotonic() < end:
        time.sleep(0.02)
    assert condition()


def run_python(code, **environment):
    """The same program's Python, with the tests' modules in reach."""
    return subprocess.run([sys.executable, "-c", "import sys; sys.path.insert(0, %r)\n" % str(clients.HERE) + code],
                          env={**clients.os.environ, **environment}, capture_output=True, text=True, timeout=120,
                          check=False)


if __name__ == "__main__":
    clients.main()
