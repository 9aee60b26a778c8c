"""A motion made by hand for the tests of NiTE's interface: of somebody nothing but a forearm and a hand is in view,
0.9 m before the sensor and a wall behind. The hand comes up, waves, pushes towards the sensor and goes. write_clip()
puts it down as PNG images that a virtual camera plays; hand_at() says where the middle of the hand is.
"""
import math
import struct
import zlib

RATE_HZ, SECONDS = 30, 7.0
WIDTH, HEIGHT, FOCAL = 320, 240, 287.5  # of a Kinect v1 at half its size
WALL_MM = 2600
ARM_M, PALM_M = 0.04, 0.045  # radii
# Time in seconds -> middle of the hand, camera space in metres (x to the sensor's left, y up).
KEYS = [(0.3, (0.1, -0.55, 0.9)), (0.9, (0.1, 0.0, 0.9)), (1.8, (0.1, 0.0, 0.9)),
        *[(1.8 + 0.35 * i, (0.22 if i % 2 else -0.02, 0.0, 0.9)) for i in range(1, 7)],
        (4.3, (0.1, 0.0, 0.9)), (4.8, (0.1, 0.0, 0.9)), (5.05, (0.1, 0.0, 0.68)), (5.3, (0.1, 0.0, 0.9)),
        (5.8, (0.1, 0.0, 0.9)), (6.4, (0.1, -0.55, 0.9))]


def hand_at(time_s):
    """Where the middle of the hand is."""
    if time_s <= KEYS[0][0]:
        return KEYS[0][1]
    for (t0, a), (t1, b) in zip(KEYS, KEYS[1:]):
        if time_s < t1:
            part = (time_s - t0) / (t1 - t0)
            part = part * part * (3 - 2 * part)
            return tuple((1 - part) * x + part * y for x, y in zip(a, b))
    return KEYS[-1][1]


def spheres(hand):
    """Middle and radius of the spheres that the arm is of: a palm with fingers, and a forearm that leads down and
    away."""
    x, y, z = hand
    for i in range(8):
        yield (x, y - 0.07 + 0.02 * i, z), PALM_M
    for i in range(20):
        yield (x + 0.004 * i, y - 0.08 - 0.02 * i, z + 0.008 * i), ARM_M


def depth_image(hand):
    """Row-major millimetres."""
    image = [WALL_MM] * (WIDTH * HEIGHT)
    for (x, y, z), radius in spheres(hand):
        u, v, reach = WIDTH / 2 - FOCAL * x / z, HEIGHT / 2 - FOCAL * y / z, FOCAL * radius / z
        for row in range(max(0, math.ceil(v - reach)), min(HEIGHT, math.floor(v + reach) + 1)):
            half = math.sqrt(max(0.0, reach * reach - (row - v) ** 2))
            for column in range(max(0, math.ceil(u - half)), min(WIDTH, math.floor(u + half) + 1)):
                aside = ((row - v) ** 2 + (column - u) ** 2) * (z / FOCAL) ** 2
                here = round(1000 * (z - math.sqrt(max(0.0, radius * radius - aside))))
                at = row * WIDTH + column
                image[at] = min(image[at], here)
    return image


def write_png(path, image):
    rows = b"".join(b"\0" + struct.pack(f">{WIDTH}H", *image[v * WIDTH:(v + 1) * WIDTH]) for v in range(HEIGHT))
    chunks = ((b"IHDR", struct.pack(">IIBBBBB", WIDTH, HEIGHT, 16, 0, 0, 0, 0)), (b"IDAT", zlib.compress(rows, 1)),
              (b"IEND", b""))
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
        for name, data in chunks))


def write_clip(folder):
    folder.mkdir(parents=True)
    for i in range(int(SECONDS * RATE_HZ)):
        write_png(folder / f"{i:06}.png", depth_image(hand_at(i / RATE_HZ)))
