"""Random changes of training people: pose in the crop, sensor noise, occlusion, left and right.

Images are x [B, 3, SIDE, SIDE] of pose_network_model.decode (depth times surface share, surface
share, hidden share); joints are [B, 20, 3], metres in the crop (x to the left, y up). All operations
are on tensors of the device, without branches, so that a GPU can replay them as a graph.
"""
import torch
from torch.nn import functional

from pose_network_model import CELL_M, DEPTH_SCALE, MIRRORED, SIDE

# Chosen by hand.
MAX_ROLL_RAD = 0.4             # of the camera
MAX_LOG_SCALE = 0.12           # of the person's size: +-13 %
MAX_SHIFT_M = (0.12, 0.12, 0.06)
NOISE_COARSE_M, NOISE_FINE_M = 0.012, 0.015  # standard deviation of blobs and of single cells
BLOBS = 12                     # across the crop
RECTANGLES = 2                 # of each kind for a person
# Probability and largest side, cells, of rectangles that are cut out of the person, that hide it,
# and that are somebody else's surface taken for the person's.
CUT, HIDE, FOREIGN = (0.2, 24), (0.2, 36), (0.15, 30)
SMALLEST_SIDE = 3              # of a rectangle, cells
FOREIGN_DEPTH_M = 0.4          # before or behind the person, at most
FOREIGN_SLOPE_M = 0.01         # per row, at most


class Random:
    """Uniform numbers for a batch, on its device."""

    def __init__(self, batch, device):
        self.batch, self.device = batch, device

    def uniform(self, low, high, *shape):
        """In [low, high), [B, *shape]."""
        return low + (high - low) * torch.rand(self.batch, *shape, device=self.device)

    def normal(self, *shape):
        """Standard normal numbers, [B, *shape]."""
        return torch.randn(self.batch, *shape, device=self.device)

    def rectangle(self, probability, largest):
        """1 inside a rectangle of each image, [B, 1, SIDE, SIDE]; 0 everywhere if it has none."""
        rows = torch.arange(SIDE, device=self.device).view(1, 1, SIDE, 1).float()
        columns = torch.arange(SIDE, device=self.device).view(1, 1, 1, SIDE).float()
        width, height = (self.uniform(SMALLEST_SIDE, largest, 1, 1, 1) for _ in range(2))
        u, v = (self.uniform(0, SIDE, 1, 1, 1) for _ in range(2))
        chosen = self.uniform(0, 1, 1, 1, 1) < probability
        inside = ((columns - u).abs() < width / 2) & ((rows - v).abs() < height / 2)
        return (inside & chosen).float()


class Mirror:
    """Left for right of joints. Its tensors are made once: a graph cannot read from elsewhere."""

    def __init__(self, device):
        self.order = torch.tensor(MIRRORED, device=device)
        self.sign = torch.tensor([-1.0, 1.0, 1.0], device=device)

    def __call__(self, joints):
        return joints[:, self.order] * self.sign


def sample(x, angle, scale, shift):
    """The images turned by angle, scaled, and shifted in x and y.

    The new image at p shows the old one at R(-angle) (p - shift) / scale. affine_grid has x to the
    right and y down, both over half the side; crops have x to the left and y up. What comes in from
    outside the crop is beside the person.
    """
    half_m = SIDE * CELL_M / 2.0
    cos, sin = torch.cos(angle), torch.sin(angle)
    theta = torch.zeros(x.shape[0], 2, 3, device=x.device)
    theta[:, 0, 0] = theta[:, 1, 1] = cos / scale
    theta[:, 0, 1], theta[:, 1, 0] = sin / scale, -sin / scale
    right, down = -shift[:, 0] / half_m, -shift[:, 1] / half_m
    theta[:, 0, 2] = -(theta[:, 0, 0] * right + theta[:, 0, 1] * down)
    theta[:, 1, 2] = -(theta[:, 1, 0] * right + theta[:, 1, 1] * down)
    grid = functional.affine_grid(theta, list(x.shape), align_corners=False)
    return functional.grid_sample(x, grid, mode="bilinear", padding_mode="zeros",
                                  align_corners=False)


def move_joints(joints, angle, scale, shift):
    """The same of joints. Both axes of the image are reversed, so the matrix is the same one."""
    cos, sin, scale = torch.cos(angle).view(-1, 1), torch.sin(angle).view(-1, 1), scale.view(-1, 1)
    x, y, z = joints.unbind(-1)
    return torch.stack([scale * (cos * x - sin * y) + shift[:, 0:1],
                        scale * (sin * x + cos * y) + shift[:, 1:2],
                        scale * z + shift[:, 2:3]], dim=-1)


def move(x, joints, random):
    """Turns, scales and shifts people. Returns depth, surface, hidden, joints."""
    angle = random.uniform(-1, 1) ** 3 * MAX_ROLL_RAD  # mostly small: cameras are about level
    scale = torch.exp(random.uniform(-MAX_LOG_SCALE, MAX_LOG_SCALE))
    unit = random.uniform(-1, 1, 3)
    shift = torch.stack([unit[:, axis] * MAX_SHIFT_M[axis] for axis in range(3)], dim=-1)
    depth, surface, hidden = sample(x, angle, scale, shift).split(1, dim=1)
    depth = depth * scale.view(-1, 1, 1, 1)
    depth = depth + DEPTH_SCALE * shift[:, 2].view(-1, 1, 1, 1) * surface
    return depth, surface, hidden, move_joints(joints, angle, scale, shift)


def add_noise(depth, surface, random):
    """Correlated blobs and independent noise of cells, of a strength for each image."""
    coarse = functional.interpolate(random.normal(1, BLOBS, BLOBS), size=SIDE, mode="bilinear",
                                    align_corners=False)
    fine = random.normal(1, SIDE, SIDE)
    strength = random.uniform(0, 1, 1, 1, 1) ** 2
    return depth + DEPTH_SCALE * surface * strength * (NOISE_COARSE_M * coarse
                                                       + NOISE_FINE_M * fine)


def occlude(depth, surface, hidden, random):
    """Rectangles without surface, hidden ones, and foreign surface beside the person."""
    rows = torch.arange(SIDE, device=depth.device).view(1, 1, SIDE, 1).float()
    for _ in range(RECTANGLES):
        cut = random.rectangle(*CUT)
        depth, surface = depth * (1 - cut), surface * (1 - cut)
        covered = random.rectangle(*HIDE)
        depth, surface = depth * (1 - covered), surface * (1 - covered)
        hidden = hidden * (1 - covered) + covered
        foreign = random.rectangle(*FOREIGN) * (surface < 0.01).float()
        level = random.uniform(-FOREIGN_DEPTH_M, FOREIGN_DEPTH_M, 1, 1, 1)
        slope = random.uniform(-FOREIGN_SLOPE_M, FOREIGN_SLOPE_M, 1, 1, 1) * (rows - SIDE / 2)
        depth = depth * (1 - foreign) + foreign * DEPTH_SCALE * (level + slope)
        surface, hidden = torch.maximum(surface, foreign), hidden * (1 - foreign)
    return depth, surface, hidden


def augment(x, joints, mirror):
    """Moves people, adds noise, occludes them and mirrors half of them. Returns x and joints."""
    random = Random(x.shape[0], x.device)
    depth, surface, hidden, joints = move(x, joints, random)
    depth = add_noise(depth, surface, random)
    depth, surface, hidden = occlude(depth, surface, hidden, random)
    flip = random.uniform(0, 1) < 0.5
    x = torch.cat([depth, surface, hidden], dim=1)
    x = torch.where(flip.view(-1, 1, 1, 1), x.flip(-1), x)
    return x, torch.where(flip.view(-1, 1, 1), mirror(joints), joints)
