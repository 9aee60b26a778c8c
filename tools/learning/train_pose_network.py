#!/usr/bin/env python3
"""Train a pose network on people that `ossa crop` cut out, on a GPU where there is one.

usage: train_pose_network.py CROPS... --out weights.npy [--validation CROPS...] [--resume]

CROPS are folders of crops.npy, joints.npy and range.npy. With --watch, folders may still be
incomplete: each is used as soon as it is complete. `ossa pack-network weights.npy --out body.ossanet`
makes the file that the tracker reads. While it trains, weights.npy.checkpoint holds the state, from
which the same command with --resume continues: on a CPU to the same weights, to the byte. Needs
PyTorch 1.13 or later (Debian: python3-torch).
"""
import argparse
import math
import os
import signal
import sys
import time

import numpy
import torch

from pose_crops import FEWEST_JOINTS, People, read_validation
from pose_network_model import PoseNetwork, decode, places, weights
from pose_training import Checkpoint, Training, save_state

# Options that an interrupted training and its continuation must share.
SETTINGS = ["people", "seconds", "batch", "rate", "decay", "seed", "start"]


def evaluate(model, people):
    """For each folder: mean error, cm; share within 10 cm; mean error that it predicts, cm."""
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


def save_weights(model, path):
    """As .npy, for `ossa pack-network`; the file appears when it is complete."""
    partial = path + ".partial.npy"
    numpy.save(partial, weights(model))
    os.replace(partial, path)


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
    if not options.people > 0 or options.batch < 1:
        parser.error("--people, --batch: expected numbers above 0")
    if options.seconds is not None and not options.seconds > 0:
        parser.error(f"--seconds: expected a number above 0, found {options.seconds}")
    for path in filter(None, [options.out, options.keep]):
        if not os.access(os.path.dirname(path) or ".", os.W_OK):
            sys.exit(f"{path}: cannot be written: expected a folder to write it in")


def parse_options():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("crops", nargs="+")
    parser.add_argument("--validation", nargs="*", default=[])
    parser.add_argument("--out", required=True)
    parser.add_argument("--people", type=float, default=65e6,
                        help="end after so many people, each read several times")
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
    parser.add_argument("--report", type=float, default=20, metavar="SECONDS",
                        help="between two reports, each with weights and checkpoint")
    parser.add_argument("--resume", action="store_true",
                        help="continue from the checkpoint of an interrupted run, if there is one")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    check(options, parser)
    return options


def read_people(options, device, already_read):
    """Training people, at least --fewest: waits for folders that --watch may still complete.

    already_read: folders of an interrupted run, which come first, in its order.
    """
    folders = already_read + [folder for folder in options.crops if folder not in already_read]
    people = People(folders, device, options.watch)
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


def find_checkpoint(checkpoint, resume):
    """What an interrupted run left; None to start at the beginning."""
    there = os.path.exists(checkpoint.path)
    if there and resume:
        return checkpoint.read()
    if there:
        print(f"{checkpoint.path}: left by an interrupted run; without --resume this one starts "
              "over and replaces it", file=sys.stderr)
    elif resume:
        print(f"{checkpoint.path}: not there: nothing to resume, this run starts over",
              file=sys.stderr)
    return None


class Run:
    """One training, new or continued, until --people or --seconds are reached."""

    def __init__(self, options, device):
        self.options, self.begun = options, time.time()
        settings = {name: getattr(options, name) for name in SETTINGS}
        settings.update(device=device, crops=sorted(options.crops))
        self.checkpoint = Checkpoint(options.out + ".checkpoint", settings)
        saved = find_checkpoint(self.checkpoint, options.resume)
        progress = saved["progress"] if saved else {"read": 0, "seconds": 0.0, "folders": []}
        self.read, self.seconds_before = progress["read"], progress["seconds"]
        self.people = read_people(options, device, progress["folders"])
        self.validation = read_validation(options.validation, device)
        print(f"{time.time() - self.begun:.0f} s: {self.people.count} people on {device}"
              f"{f', {self.read} read before' if saved else ''}", flush=True)
        self.training = start_training(options, device)
        if saved:
            self.training.restore(saved["training"])
        self.started, self.interrupted = time.time(), False

    def seconds(self):
        """Of training, those before an interruption included."""
        return self.seconds_before + time.time() - self.started

    def done(self):
        """In 0..1."""
        if self.options.seconds:
            return self.seconds() / self.options.seconds
        return self.read / self.options.people

    def report(self, loss=""):
        print(f"{time.time() - self.begun:.0f} s: {self.read} read of {self.people.count} people"
              f"{loss}; {evaluate(self.training.average, self.validation)}", flush=True)

    def write(self):
        save_weights(self.training.average, self.options.out)
        if self.options.keep:
            save_state(self.training.average.state_dict(), self.options.keep)

    def write_checkpoint(self):
        self.checkpoint.write(self.training, {"read": self.read, "seconds": self.seconds(),
                                              "folders": self.people.folders})

    def step(self, done):
        # Up within the first hundredth, then down along a cosine.
        rate = min(1.0, done / 0.01 + 0.01) * (0.01 + 0.99 * 0.5 * (1 + math.cos(math.pi * done)))
        crops, joints = self.people.batch(self.options.batch)
        self.training.step(crops, joints, self.options.rate * rate)
        self.read += len(crops)

    def interrupt(self, number, _):
        """Signal handler: the run ends after its step; a second signal ends it at once."""
        self.interrupted = True
        signal.signal(number, signal.SIG_DFL)

    def train(self):
        """Returns False if it was interrupted."""
        reported = time.time()
        while (done := self.done()) < 1:
            if self.interrupted:
                self.write_checkpoint()
                return False
            self.step(done)
            if time.time() - reported >= self.options.report:
                self.people.read()
                self.report(f", loss {self.training.loss.item():.3f}")
                self.write()
                self.write_checkpoint()
                reported = time.time()
        self.write()
        self.report()
        self.checkpoint.remove()
        return True


def main():
    options = parse_options()
    device = "cuda" if torch.cuda.is_available() else "cpu"
    torch.manual_seed(options.seed)
    torch.backends.cudnn.benchmark = True
    run = Run(options, device)
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, run.interrupt)
    if not run.train():
        sys.exit(f"interrupted: the same command with --resume goes on from {run.checkpoint.path}")


if __name__ == "__main__":
    main()
