"""Receivers of what `ossa track --send` sends, on python-osc, and the room that its places are in, computed anew from
the skeleton file of the same run."""
import json
import math
import os
import pathlib
import shutil
import socket
import subprocess
import sys
import threading
import unittest

BUILD = pathlib.Path(os.environ["OSSA_BUILD"])
WORK = pathlib.Path(os.environ["OSSA_WORK"])  # of this test alone
SOURCE = pathlib.Path(os.environ["OSSA_SOURCE"])
sys.path.insert(0, str(SOURCE / "tests" / "support"))
import pypi  # noqa: E402

pypi.fetch(BUILD / "python_packages")
from pythonosc.osc_bundle import OscBundle  # noqa: E402


def main():
    shutil.rmtree(WORK, ignore_errors=True)
    WORK.mkdir(parents=True)
    unittest.main()


class Receiver:
    """Keeps the datagrams that come to a free port of this machine."""

    def __init__(self, count=1):
        self.sockets = bind_in_a_row(count)
        self.port = self.sockets[0].getsockname()[1]
        self.datagrams = [[] for _ in self.sockets]
        self.threads = [threading.Thread(target=self.listen, args=(i,), daemon=True) for i in range(count)]
        for thread in self.threads:
            thread.start()

    def listen(self, i):
        while True:
            data = self.sockets[i].recv(65536)
            if data == b"end":
                return
            self.datagrams[i].append(data)

    def finish(self):
        """All that came, by port."""
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as end:
            for one in self.sockets:
                end.sendto(b"end", one.getsockname())
        for thread in self.threads:
            thread.join()
        for one in self.sockets:
            one.close()
        return self.datagrams


def bind_in_a_row(count):
    for _ in range(100):
        sockets = [socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in range(count)]
        for one in sockets:
            one.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 22)
        sockets[0].bind(("127.0.0.1", 0))
        first = sockets[0].getsockname()[1]
        try:
            for i, one in enumerate(sockets[1:], 1):
                one.bind(("127.0.0.1", first + i))
            return sockets
        except OSError:
            continue
    raise OSError("no free ports in a row")


def track(clip, out, *targets, expect=0, options=()):
    command = [str(BUILD / "bin" / "ossa"), "track", str(clip), "--out", str(out), "--quiet", *options]
    for target in targets:
        command += ["--send", target]
    result = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    assert result.returncode == expect, (command, result.stderr)
    return result


def frames_of(out):
    return [json.loads(line) for line in out.read_text().splitlines()]


def messages(datagram):
    """(address, values) of a bundle."""
    return [(message.address, list(message.params)) for message in OscBundle(datagram)]


def room_of(frames):
    """For each frame: a function from camera space to the room: Unity's axes, floor at 0, who faces the sensor faces +z."""
    mean, count, result = None, 0, []
    for frame in frames:
        if "floor" in frame:
            count += 1
            mean = frame["floor"] if mean is None else [m + (f - m) / count for m, f in zip(mean, frame["floor"])]
            length = math.hypot(*mean[:3])
            mean = [m / length for m in mean]
        assert mean is not None, "the clips of these tests show a floor"
        result.append(lambda p, plane=tuple(mean): level(p, plane))
    return result


def level(p, plane):
    normal, height = plane[:3], plane[3]
    axis, c = (-normal[2], 0.0, normal[0]), normal[1]  # normal x up, and the cosine of the turn
    k = cross(axis, p)
    kk = cross(axis, k)
    x, y, z = (p[i] + k[i] + kk[i] / (1 + c) for i in range(3))
    return x, y + height, -z


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def rotate(q, v):
    """Quaternion x y z w."""
    t = [2 * c for c in cross(q[:3], v)]
    u = cross(q[:3], t)
    return tuple(v[i] + q[3] * t[i] + u[i] for i in range(3))


def multiply(a, b):
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw, aw * bw - ax * bx - ay * by - az * bz)


def unit(v):
    length = math.hypot(*v)
    return tuple(c / length for c in v)
