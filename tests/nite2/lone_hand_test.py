"""libNiTE2.so where no body is in view: a forearm before the sensor, as the PyPI package `openni` sees it."""
import unittest

import arm_clip
import clients
from clients import distance, place
from openni import nite2

WAVE, CLICK, RAISE = 0, 1, 2
COMPLETED = 4
LOST, NEW, TRACKED, TOUCHING = 0, 1, 2, 4


class Moment:
    """A copy of the results of a hand tracker for one depth frame."""

    def __init__(self, frame):
        self.time_s = frame.frameIndex / arm_clip.RATE_HZ
        self.hands = {h.id: (int(h.state), place(h.position)) for h in frame.hands}
        self.done = [int(g.type) for g in frame.gestures if int(g.state) == COMPLETED]


def play(clip):
    """All moments of the clip; a hand is asked for near the one in view at 1.2 s, and one where none is; the place of
    the wave is followed like NiTE's samples do. Returns moments and the three ids."""
    hands = nite2.HandTracker(clients.camera(clip))
    for gesture in (WAVE, CLICK, RAISE):
        hands.start_gesture_detection(gesture)
    moments, near, nowhere, waved = [], None, None, None
    while True:
        try:
            frame = hands.read_frame()
        except clients.NiteError:
            return moments, (near, nowhere, waved)  # the clip's end: the camera is unplugged
        moments.append(Moment(frame))
        if near is None and moments[-1].time_s > 1.2:
            near = hands.start_hand_tracking(-200.0, 50.0, 900.0).value  # NiTE's x runs to the image's right
            nowhere = hands.start_hand_tracking(700.0, 0.0, 2600.0).value  # the wall
        for gesture in frame.gestures:
            if waved is None and (int(gesture.type), int(gesture.state)) == (WAVE, COMPLETED):
                waved = hands.start_hand_tracking(gesture.currentPosition).value
        frame.close()


class Arm(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        clients.start()
        cls.addClassCleanup(clients.stop)
        arm_clip.write_clip(clients.WORK / "arm")
        cls.moments, (cls.near, cls.nowhere, cls.waved) = play(clients.WORK / "arm")

    def way_of(self, hand):
        """(time, state, place) of a hand by id."""
        return [(m.time_s, *m.hands[hand]) for m in self.moments if hand in m.hands]

    def test_nearest_hand_is_tracked_until_it_leaves(self):
        way = self.way_of(self.near)
        self.assertEqual(way[0][1] & ~TOUCHING, NEW)
        self.assertEqual({state & ~TOUCHING for _, state, _ in way[1:-1]}, {TRACKED})
        self.assertEqual(way[-1][1], LOST)
        self.assertGreater(way[-1][0], 6.0)
        errors = [distance(at, arm_clip.hand_at(t)) for t, _, at in way if t < 5.8]
        self.assertLess(max(errors), 0.10)
        self.assertLess(sum(errors) / len(errors), 0.06)

    def test_place_without_a_hand_is_lost_at_once(self):
        self.assertEqual([state for _, state, _ in self.way_of(self.nowhere)], [LOST])

    def test_raise_wave_and_click_complete_at_their_time(self):
        done = {kind: [m.time_s for m in self.moments if kind in m.done] for kind in (WAVE, CLICK, RAISE)}
        self.assertTrue(any(0.6 < t < 1.8 for t in done[RAISE]), done)
        self.assertTrue(done[WAVE] and all(2.2 < t < 4.5 for t in done[WAVE]), done)
        self.assertTrue(done[CLICK] and all(4.9 < t < 5.8 for t in done[CLICK]), done)

    def test_waving_hand_is_tracked_from_its_gesture(self):
        way = self.way_of(self.waved)
        self.assertEqual(way[0][1] & ~TOUCHING, NEW)
        self.assertLess(distance(way[-1][2], arm_clip.hand_at(way[-1][0])), 0.6)
        self.assertGreater(len(way), 20)


if __name__ == "__main__":
    clients.main()
