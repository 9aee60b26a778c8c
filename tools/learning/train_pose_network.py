#!/usr/bin/env python3
"""Train a pose network on people that `ossa crop` cut out, on a GPU where there is one.

usage: train_pose_network.py CROPS... --out weights.npy [--validation CROPS...]

CROPS are folders of crops.npy, joints.npy and range.npy; folders that are not whole yet are taken
along as soon as they are. `ossa pack-network weights.npy --out body.ossanet` makes the file that the
tracker reads. Needs PyTorch 1.13 or later (Debian: python3-torch).
"""
import argparse
import copy
import math
import os
import sys
import time

import numpy
import torch
from torch import nn
from torch.nn import functional

# Of recon/refine/person_crop.h and pose_network.h; what the network reads is fixed there.
SIDE = 96         # cells
CELL_M = 0.025
JOINTS = 20
MIRRORED = [0, 1, 2, 3, 8, 9, 10, 11, 4, 5, 6, 7, 16, 17, 18, 19, 12, 13, 14, 15]
DEPTH_SCALE = 2.0  # inputs a metre
OFFSET_M = 0.2     # of an output of 1
OUTPUTS = 5        # of each joint: vote, offset (3), logarithm of the error's scale

# By hand.
FEWEST_JOINTS = 10    # that are known, of a person to learn from
FOLDERS_A_BATCH = 16  # that a batch is taken of
AVERAGED = 4          # steps from one addition to the mean of the weights to the next


class Block(nn.Module):
    """Two convolutions beside an identity (He et al. 2016)."""

    def __init__(self, channels):
        super().__init__()
        self.first = nn.Conv2d(channels, channels, 3, padding=1, bias=False)
        self.first_norm = nn.BatchNorm2d(channels)
        self.second = nn.Conv2d(channels, channels, 3, padding=1, bias=False)
        self.second_norm = nn.BatchNorm2d(channels)

    def forward(self, x):
        y = functional.relu(self.first_norm(self.first(x)))
        return functional.relu(x + self.second_norm(self.second(y)))


class Step(nn.Module):
    """A convolution, normalised and rectified."""

    def __init__(self, inputs, outputs, size, stride):
        super().__init__()
        self.conv = nn.Conv2d(inputs, outputs, size, stride, size // 2, bias=False)
        self.norm = nn.BatchNorm2d(outputs)

    def forward(self, x):
        return functional.relu(self.norm(self.conv(x)))


class PoseNetwork(nn.Module):
    """Every cell of a 12 x 12 map votes for each joint (after Xiong et al. 2019, "A2J")."""

    def __init__(self, widths=(32, 48, 80, 128, 96)):
        super().__init__()
        a, b, c, d, e = widths
        self.down1, self.down2, self.down3 = Step(3, a, 5, 2), Step(a, b, 3, 2), Step(b, c, 3, 2)
        self.near = Block(c)
        self.down4 = Step(c, d, 3, 2)
        self.far1, self.far2 = Block(d), Block(d)
        self.up = nn.Conv2d(d, c, 1)
        self.join = Step(c, e, 3, 1)
        self.head = nn.Conv2d(e, JOINTS * OUTPUTS, 1)

    def forward(self, x):
        near = self.near(self.down3(self.down2(self.down1(x))))
        far = self.up(self.far2(self.far1(self.down4(near))))
        near = near + functional.interpolate(far, scale_factor=2.0, mode="nearest")
        return self.head(self.join(near))


def places(out):
    """Of each joint the place, metres in the crop [B, 20, 3], and the log of the error's scale."""
    batch, _, rows, columns = out.shape
    out = out.float().view(batch, JOINTS, OUTPUTS, rows * columns)
    votes = torch.softmax(out[:, :, 0], dim=-1)
    step = SIDE * CELL_M / columns
    at = (columns - 1) / 2.0 - torch.arange(columns, device=out.device, dtype=torch.float32)
    x = (at * step).repeat(rows)
    y = (at * step).repeat_interleave(columns)
    place = torch.stack([(votes * (OFFSET_M * out[:, :, 1] + x)).sum(-1),
                         (votes * (OFFSET_M * out[:, :, 2] + y)).sum(-1),
                         (votes * (OFFSET_M * out[:, :, 3])).sum(-1)], dim=-1)
    return place, (votes * out[:, :, 4]).sum(-1)


def loss_of(out, joints):
    """Laplace's negative log-likelihood of the distance, per joint that is known."""
    place, log_scale = places(out)
    known = torch.isfinite(joints).all(-1)
    error = torch.sqrt(((place - torch.nan_to_num(joints)) ** 2).sum(-1) + 1e-5)
    log_scale = log_scale.clamp(-5.0, 2.0)
    # In units of 0.1 m: a scale of 0 is 10 cm.
    each = 10.0 * error * torch.exp(-log_scale) + 3.0 * log_scale
    return (each * known).sum() / known.sum().clamp(min=1)


def decode(crops):
    """uint8 [B, 2, 96, 96] to what the network reads: depth times share, surface, hidden."""
    cells = crops[:, 1].float()
    surface = torch.floor(cells / 5.0)
    hidden = cells - 5.0 * surface
    surface, hidden = surface / 4.0, hidden / 4.0
    behind = 0.01 * (crops[:, 0].float() - 128.0)
    return torch.stack([DEPTH_SCALE * behind * surface, surface, hidden], dim=1)


def augment(x, joints, mirror):
    """Turns, scales and shifts people, mirrors half of them, cuts pieces out, covers others."""
    batch, device = x.shape[0], x.device

    def uniform(low, high, *shape):
        return low + (high - low) * torch.rand(*shape, device=device)

    angle = uniform(-1, 1, batch) ** 3 * 0.4            # mostly small: cameras are about level
    scale = torch.exp(uniform(-0.12, 0.12, batch))
    shift = uniform(-0.12, 0.12, batch, 3)
    shift[:, 2] *= 0.5
    # The new image at p shows the old one at R(-angle) (p - shift) / scale; affine_grid has x to
    # the right and y down, both over half the side; crops have x to the left and y up.
    half = SIDE * CELL_M / 2.0
    cos, sin = torch.cos(angle), torch.sin(angle)
    theta = torch.zeros(batch, 2, 3, device=device)
    theta[:, 0, 0] = theta[:, 1, 1] = cos / scale
    theta[:, 0, 1], theta[:, 1, 0] = sin / scale, -sin / scale
    sx, sy = -shift[:, 0] / half, -shift[:, 1] / half
    theta[:, 0, 2] = -(theta[:, 0, 0] * sx + theta[:, 0, 1] * sy)
    theta[:, 1, 2] = -(theta[:, 1, 0] * sx + theta[:, 1, 1] * sy)
    grid = functional.affine_grid(theta, list(x.shape), align_corners=False)
    # What comes in from outside the crop is not known; it is beside the person.
    x = functional.grid_sample(x, grid, mode="bilinear", padding_mode="zeros", align_corners=False)
    surface = x[:, 1:2]
    depth = x[:, 0:1] * scale.view(-1, 1, 1, 1)
    # In the image's axes (x right, y down) points turn by the same matrix inverted, so in ours too.
    old_x, old_y = joints[..., 0], joints[..., 1]
    c, s = cos.view(-1, 1), sin.view(-1, 1)
    joints = torch.stack([scale.view(-1, 1) * (c * old_x - s * old_y) + shift[:, 0:1],
                          scale.view(-1, 1) * (s * old_x + c * old_y) + shift[:, 1:2],
                          scale.view(-1, 1) * joints[..., 2] + shift[:, 2:3]], dim=-1)
    depth = depth + DEPTH_SCALE * shift[:, 2].view(-1, 1, 1, 1) * surface
    # Noise of a frame: correlated blobs and single cells.
    coarse = torch.randn(batch, 1, 12, 12, device=device)
    coarse = functional.interpolate(coarse, size=SIDE, mode="bilinear", align_corners=False)
    fine = torch.randn(batch, 1, SIDE, SIDE, device=device)
    strength = uniform(0, 1, batch, 1, 1, 1) ** 2
    depth = depth + DEPTH_SCALE * surface * strength * (0.012 * coarse + 0.015 * fine)
    hidden = x[:, 2:3]
    # Rectangles: cut out of the person, covered, or somebody else's surface taken for theirs.
    rows = torch.arange(SIDE, device=device).view(1, 1, SIDE, 1).float()
    columns = torch.arange(SIDE, device=device).view(1, 1, 1, SIDE).float()

    def rectangle(share, largest):
        width = uniform(3, largest, batch, 1, 1, 1)
        height = uniform(3, largest, batch, 1, 1, 1)
        u, v = uniform(0, SIDE, batch, 1, 1, 1), uniform(0, SIDE, batch, 1, 1, 1)
        chosen = uniform(0, 1, batch, 1, 1, 1) < share
        inside = ((columns - u).abs() < width / 2) & ((rows - v).abs() < height / 2)
        return (inside & chosen).float()

    for _ in range(2):
        cut = rectangle(0.2, 24)
        depth, surface = depth * (1 - cut), surface * (1 - cut)
        covered = rectangle(0.2, 36)
        depth, surface = depth * (1 - covered), surface * (1 - covered)
        hidden = hidden * (1 - covered) + covered
        other = rectangle(0.15, 30) * (surface < 0.01).float()
        level = uniform(-0.4, 0.4, batch, 1, 1, 1)
        slope = uniform(-0.01, 0.01, batch, 1, 1, 1) * (rows - SIDE / 2)
        depth = depth * (1 - other) + other * DEPTH_SCALE * (level + slope)
        surface, hidden = torch.maximum(surface, other), hidden * (1 - other)
    flip = uniform(0, 1, batch) < 0.5
    x = torch.cat([depth, surface, hidden], dim=1)
    x = torch.where(flip.view(-1, 1, 1, 1), x.flip(-1), x)
    return x, torch.where(flip.view(-1, 1, 1), mirror(joints), joints)


class Mirror:
    """Left for right of joints. Its numbers wait on the device: a graph takes none from elsewhere."""

    def __init__(self, device):
        self.order = torch.tensor(MIRRORED, device=device)
        self.sign = torch.tensor([-1.0, 1.0, 1.0], device=device)

    def __call__(self, joints):
        return joints[:, self.order] * self.sign


class People:
    """All crops read so far: in the memory of a GPU, else left on the disk until they are read."""

    def __init__(self, folders, device, watch):
        self.waiting, self.device, self.watch = list(folders), device, watch
        self.crops, self.joints, self.count = [], [], 0
        self.read()

    def read(self):
        """Takes along folders that are whole now."""
        for folder in list(self.waiting):
            if not os.path.exists(os.path.join(folder, "joints.npy")):
                continue
            on_disk = "r" if self.device == "cpu" else None
            crops = numpy.load(os.path.join(folder, "crops.npy"), mmap_mode=on_disk)
            joints = numpy.load(os.path.join(folder, "joints.npy"))
            known = numpy.flatnonzero(numpy.isfinite(joints).all(-1).sum(-1) >= FEWEST_JOINTS)
            if self.device == "cpu":
                self.crops.append((crops, known))
            else:
                self.crops.append((torch.from_numpy(crops[known]).to(self.device), None))
            self.joints.append(torch.from_numpy(joints[known]).to(self.device))
            self.count += len(known)
            self.waiting.remove(folder)
        if self.waiting and not self.watch:
            sys.exit(f"{self.waiting[0]}: expected joints.npy, found none")

    def take(self, part, which):
        """Crops and joints of some people of a folder."""
        crops, known = self.crops[part]
        if known is not None:
            return torch.from_numpy(crops[known[which.numpy()]]), self.joints[part][which]
        return crops[which], self.joints[part][which]

    def batch(self, size):
        """At random: a few folders by their sizes, then as many people of each."""
        sizes = torch.tensor([float(len(joints)) for joints in self.joints])
        few = min(FOLDERS_A_BATCH, size)
        parts = torch.multinomial(sizes, few, replacement=True).tolist()
        taken = [self.take(part, torch.randint(len(self.joints[part]), (size // few,),
                                               device=self.device)) for part in parts]
        return torch.cat([crops for crops, _ in taken]), torch.cat([joints for _, joints in taken])


def evaluate(model, people):
    """Mean error, cm, share within 10 cm, and mean scale of what it says, cm, of each folder."""
    model.eval()
    lines = []
    with torch.no_grad():
        for part, all_joints in enumerate(people.joints):
            errors, scales = [], []
            for which in torch.arange(len(all_joints), device=people.device).split(512):
                crops, joints = people.take(part, which)
                place, scale = places(model(decode(crops)))
                errors.append((place - joints).norm(dim=-1))
                scales.append(scale)
            error = torch.cat(errors)
            known = torch.isfinite(error)
            error = error[known]
            scale = 10 * torch.exp(torch.cat(scales)[known])
            lines.append(f"{100 * error.mean():.2f} cm {100 * (error < 0.1).float().mean():.1f} % "
                         f"({3 * scale.mean():.1f})")
    return "; ".join(lines)


class Training:
    """Steps of a model, and the mean of its late weights, which errs less than the last ones."""

    def __init__(self, model, options, device):
        self.model, self.device = model, device
        self.average = copy.deepcopy(model)
        self.mirror = Mirror(device)
        on_gpu = device == "cuda"
        # A graph reads what is in the GPU's memory: the rate, too.
        self.rate = torch.tensor(options.rate, device=device) if on_gpu else options.rate
        self.optimiser = torch.optim.AdamW(model.parameters(), lr=self.rate,
                                           weight_decay=options.decay, capturable=on_gpu)
        self.prepare, self.lose = self.prepared, self.lost
        if options.fuse:
            self.prepare, self.lose = torch.compile(self.prepared), torch.compile(self.lost)
        self.graph, self.steps = None, 0
        self.crops = self.joints = self.loss = None

    def prepared(self, crops, joints):
        x, wanted = augment(decode(crops), joints, self.mirror)
        return x.contiguous(memory_format=torch.channels_last), wanted

    def lost(self, x, wanted):
        with torch.autocast(self.device, dtype=torch.bfloat16, enabled=self.device == "cuda"):
            out = self.model(x)
        return loss_of(out, wanted)

    def learn(self):
        """From the people who are in self.crops and self.joints."""
        with torch.no_grad():
            x, wanted = self.prepare(self.crops, self.joints)
        self.optimiser.zero_grad(set_to_none=True)
        loss = self.lose(x, wanted)
        loss.backward()
        nn.utils.clip_grad_norm_(self.model.parameters(), 5.0)
        self.optimiser.step()
        self.loss = loss.detach()

    def record(self):
        """A step as a graph: to launch a GPU's kernels one by one takes longer than they do."""
        aside = torch.cuda.Stream()
        aside.wait_stream(torch.cuda.current_stream())
        with torch.cuda.stream(aside):
            for _ in range(3):  # what is made at a first call is no part of the graph
                self.learn()
        torch.cuda.current_stream().wait_stream(aside)
        self.graph = torch.cuda.CUDAGraph()
        with torch.cuda.graph(self.graph):
            self.learn()

    def step(self, crops, joints, rate):
        """Learns from a batch; all are of one size."""
        if self.device == "cpu":
            for group in self.optimiser.param_groups:
                group["lr"] = rate
            self.crops, self.joints = crops, joints
            self.learn()
        else:
            self.rate.fill_(rate)
            if self.graph is None:
                self.crops, self.joints = crops.clone(), joints.clone()
                self.record()
            self.crops.copy_(crops)
            self.joints.copy_(joints)
            self.graph.replay()
        self.steps += 1
        if self.steps % AVERAGED == 0:
            self.take_mean(min(0.995, self.steps / (self.steps + 40.0)))

    def take_mean(self, keep):
        with torch.no_grad():
            for mine, theirs in zip(self.average.parameters(), self.model.parameters()):
                mine.lerp_(theirs, 1 - keep)
            for mine, theirs in zip(self.average.buffers(), self.model.buffers()):
                if mine.dtype != torch.int64:
                    mine.lerp_(theirs, 1 - keep)


def fold(conv, norm):
    """Weights and bias of a convolution and the normalisation after it, as one convolution."""
    factor = norm.weight / torch.sqrt(norm.running_var + norm.eps)
    return conv.weight * factor.view(-1, 1, 1, 1), norm.bias - norm.running_mean * factor


def weights(model):
    """All layers in the order in which they run: of each a head (inputs, outputs, size, stride),
    the weights [rows, columns, inputs, outputs], the bias."""
    layers = []
    for name in ["down1", "down2", "down3"]:
        layers.append((*fold(getattr(model, name).conv, getattr(model, name).norm), 2))
    layers.append((*fold(model.near.first, model.near.first_norm), 1))
    layers.append((*fold(model.near.second, model.near.second_norm), 1))
    layers.append((*fold(model.down4.conv, model.down4.norm), 2))
    for block in [model.far1, model.far2]:
        layers.append((*fold(block.first, block.first_norm), 1))
        layers.append((*fold(block.second, block.second_norm), 1))
    layers.append((model.up.weight, model.up.bias, 1))
    layers.append((*fold(model.join.conv, model.join.norm), 1))
    layers.append((model.head.weight, model.head.bias, 1))
    flat = []
    for weight, bias, stride in layers:
        outputs, inputs, size, _ = weight.shape
        flat.append(torch.tensor([inputs, outputs, size, stride], dtype=torch.float32))
        flat.append(weight.detach().float().cpu().permute(2, 3, 1, 0).reshape(-1))
        flat.append(bias.detach().float().cpu())
    return torch.cat(flat).numpy()


def save(model, path):
    """The file appears when it is complete."""
    partial = path + ".partial.npy"
    numpy.save(partial, weights(model))
    os.replace(partial, path)


def keep_state(model, path):
    """The file appears when it is complete."""
    torch.save(model.state_dict(), path + ".partial")
    os.replace(path + ".partial", path)


def is_running(process):
    if process is None:
        return False
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    return True


def check(options, parser):
    """Checks options and output paths at the start, before hours of training."""
    if options.people <= 0 or options.batch < 1:
        parser.error("--people, --batch: expected numbers above 0")
    for path in filter(None, [options.out, options.keep]):
        if not os.access(os.path.dirname(path) or ".", os.W_OK):
            sys.exit(f"{path}: cannot be written: expected a folder to write it in")


def read_validation(folders, device):
    """People to validate on: some of each folder."""
    people = People(folders, device, None)
    for folder, joints in zip(folders, people.joints):
        if len(joints) == 0:
            sys.exit(f"{folder}: expected people of {FEWEST_JOINTS} known joints, found none")
    return people


def parse_options():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("crops", nargs="+")
    parser.add_argument("--validation", nargs="*", default=[])
    parser.add_argument("--out", required=True)
    parser.add_argument("--people", type=float, default=65e6, help="read in all, with repetition")
    parser.add_argument("--seconds", type=float, help="end after so long instead")
    parser.add_argument("--fewest", type=int, default=1, help="start when there are so many people")
    parser.add_argument("--batch", type=int, default=1024)
    parser.add_argument("--rate", type=float, default=3e-3, help="of learning, at its highest")
    parser.add_argument("--decay", type=float, default=0.02, help="of weights, times the rate")
    parser.add_argument("--fuse", action="store_true",
                        help="by torch.compile (PyTorch 2 and a C++ compiler): a minute to begin, "
                             "then twice as fast on a GPU")
    parser.add_argument("--watch", type=int, metavar="PID",
                        help="folders may become complete while this process runs")
    parser.add_argument("--start", help="a .pt file of --keep to start from")
    parser.add_argument("--keep", help="also write the network as a PyTorch state")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    check(options, parser)
    return options


def read_people(options, device):
    """Training people, at least --fewest: waits for folders that --watch may still complete."""
    people = People(options.crops, device, options.watch)
    while people.count < options.fewest:
        may_come = people.waiting and is_running(options.watch)
        people.read()
        if people.count < options.fewest and not may_come:
            sys.exit(f"expected at least {options.fewest} people of {FEWEST_JOINTS} known joints, "
                     f"found {people.count}")
        time.sleep(1)
    return people


def start_training(options, device):
    model = PoseNetwork().to(device)
    if options.start:
        model.load_state_dict(torch.load(options.start, map_location=device))
    model = model.to(memory_format=torch.channels_last)
    model.train()
    return Training(model, options, device)


def write(model, options):
    save(model, options.out)
    if options.keep:
        keep_state(model, options.keep)


def train(training, people, options, report):
    """Trains for --people or --seconds. Every 20 seconds writes the averaged network and calls
    report(number of people read, loss). Returns the number of people read."""
    start, read, reported = time.time(), 0, time.time()
    while True:
        if options.seconds:
            done = (time.time() - start) / options.seconds
        else:
            done = read / options.people
        if done >= 1:
            return read
        # Up within the first hundredth, then down along a cosine.
        rate = min(1.0, done / 0.01 + 0.01) * (0.01 + 0.99 * 0.5 * (1 + math.cos(math.pi * done)))
        crops, joints = people.batch(options.batch)
        training.step(crops, joints, options.rate * rate)
        read += len(crops)
        if time.time() - reported > 20:
            people.read()
            report(read, f"loss {training.loss.item():.3f}; ")
            write(training.average, options)
            reported = time.time()


def main():
    options = parse_options()
    begun = time.time()
    device = "cuda" if torch.cuda.is_available() else "cpu"
    torch.manual_seed(options.seed)
    torch.backends.cudnn.benchmark = True
    people = read_people(options, device)
    validation = read_validation(options.validation, device)
    print(f"{time.time() - begun:.0f} s: {people.count} people on {device}", flush=True)
    training = start_training(options, device)

    def report(read, loss=""):
        print(f"{time.time() - begun:.0f} s: {read} read of {people.count} people"
              f"{', ' + loss if loss else '; '}{evaluate(training.average, validation)}", flush=True)

    read = train(training, people, options, report)
    write(training.average, options)
    report(read)


if __name__ == "__main__":
    main()
