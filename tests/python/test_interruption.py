"""Ctrl-C, and any other exception that a signal handler raises, ends long calls unchanged."""

import contextlib
import signal
import struct
import subprocess
import sys
import threading
import time
import zlib

import pytest

import ossa

EMPTY_FRAMES = 3000  # far more than are looked through until the signal comes


class Rung(Exception):
    """The exception of the handler, which is none of ossa's."""


@contextlib.contextmanager
def ringing(after_s):
    """Raises Rung inside the with statement after that many seconds."""

    def ring(*_):
        raise Rung

    before = signal.signal(signal.SIGALRM, ring)
    signal.setitimer(signal.ITIMER_REAL, after_s)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


@pytest.fixture
def empty_room(tmp_path):
    """A folder of images of a wall, 640x480, in which nobody is ever found upright."""
    row = b"\0" + struct.pack(">H", 3001) * 640
    chunks = {
        b"IHDR": struct.pack(">IIBBBBB", 640, 480, 16, 0, 0, 0, 0),
        b"IDAT": zlib.compress(row * 480),
        b"IEND": b"",
    }
    png = b"\x89PNG\r\n\x1a\n"
    for kind, data in chunks.items():
        png += struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    (tmp_path / "room").mkdir()
    (tmp_path / "room/0.png").write_bytes(png)
    for i in range(1, EMPTY_FRAMES):
        (tmp_path / f"room/{i}.png").symlink_to("0.png")
    return tmp_path / "room"


def test_interrupt_ends_the_wait_for_a_device():
    with pytest.raises(Rung), ringing(0.3):
        ossa.open("openni:", wait_s=60)


def test_another_thread_ends_the_wait_for_a_device():
    stop = threading.Event()
    began, ended = time.monotonic(), []

    def wait():
        with pytest.raises(ossa.InputError, match="openni:"):
            ossa.open("openni:", wait_s=60, keep_waiting=lambda: not stop.is_set())
        ended.append(time.monotonic() - began)

    waiting = threading.Thread(target=wait)
    waiting.start()
    stop.set()
    waiting.join(20)
    assert ended and ended[0] < 20


def test_an_error_of_keep_waiting_is_raised():
    def ask():
        raise RuntimeError("asked")

    with pytest.raises(RuntimeError, match="asked"):
        ossa.open("openni:", wait_s=60, keep_waiting=ask)


def test_interrupt_ends_the_search_for_the_upright_rotation(empty_room, models):
    tracker = ossa.Tracker(models=models)
    source = ossa.open(empty_room, depth_scale=1000, fps=200)
    with pytest.raises(Rung), ringing(0.3):
        next(tracker.run(source))


def test_interrupted_learning_writes_no_file(clip, tmp_path):
    truth = ossa.read_skeletons(clip / "truth.jsonl")
    out = tmp_path / "errors.ossagp"
    for after_s in (0.02, 0.1, 0.3):
        began = time.monotonic()
        try:
            with ringing(after_s):
                ossa.learn([truth] * 20, [truth] * 20, out, regions=10, samples=10)
        except Rung:
            assert not out.exists()
        assert time.monotonic() - began < 60
        out.unlink(missing_ok=True)


TRACKS_ON = """
import threading, time, ossa
images = list(ossa.open({clip!r}))
tracker = ossa.Tracker(method="none")
source = ossa.open("openni:ossa://" + {clip!r} + "?loop=1") if {live} else None
def work():
    for n in range(10000):
        depth_mm, camera, _ = next(iter(source)) if source else images[n % len(images)]
        tracker.track(depth_mm, camera, n / 30)
threading.Thread(target=work, daemon=True).start()
time.sleep({after_s})
"""


@pytest.mark.parametrize("live, after_s", [(False, 0.1), (False, 0.13), (True, 0.3)])
def test_program_exits_while_a_daemon_thread_tracks(live, after_s, clip):
    code = TRACKS_ON.format(clip=str(clip), live=live, after_s=after_s)
    ended = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120)
    assert ended.returncode == 0, ended.stderr
    assert ended.stderr == ""
