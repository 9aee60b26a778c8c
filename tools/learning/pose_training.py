"""Training of the pose network: steps on a CPU or, as a graph, on a GPU, and checkpoints."""
import copy
import os
import sys

import torch
from torch import nn

from pose_augmentation import Mirror, augment
from pose_network_model import decode, loss_of

STEPS_BETWEEN_AVERAGES = 4  # steps from one addition to the mean of the weights to the next; by hand


class Training:
    """Steps of a model, and the mean of its late weights, which has smaller errors than the last."""

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
        """One step from the people in self.crops and self.joints."""
        with torch.no_grad():
            x, wanted = self.prepare(self.crops, self.joints)
        self.optimiser.zero_grad(set_to_none=True)
        loss = self.lose(x, wanted)
        loss.backward()
        nn.utils.clip_grad_norm_(self.model.parameters(), 5.0)
        self.optimiser.step()
        self.loss = loss.detach()

    def record(self):
        """Records a step as a graph: launching a GPU's kernels one by one takes longer than they do."""
        aside = torch.cuda.Stream()
        aside.wait_stream(torch.cuda.current_stream())
        with torch.cuda.stream(aside):
            for _ in range(3):  # what a first call allocates is not part of the graph
                self.learn()
        torch.cuda.current_stream().wait_stream(aside)
        self.graph = torch.cuda.CUDAGraph()
        with torch.cuda.graph(self.graph):
            self.learn()

    def step(self, crops, joints, rate):
        """Learns from a batch; all batches have one size."""
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
        if self.steps % STEPS_BETWEEN_AVERAGES == 0:
            self.take_mean(min(0.995, self.steps / (self.steps + 40.0)))

    def take_mean(self, keep):
        with torch.no_grad():
            for mine, theirs in zip(self.average.parameters(), self.model.parameters()):
                mine.lerp_(theirs, 1 - keep)
            for mine, theirs in zip(self.average.buffers(), self.model.buffers()):
                if mine.dtype != torch.int64:
                    mine.lerp_(theirs, 1 - keep)

    def state(self):
        """Everything that the next step depends on, the random numbers included."""
        state = {"steps": self.steps, "model": self.model.state_dict(),
                 "average": self.average.state_dict(), "optimiser": self.optimiser.state_dict(),
                 "random": torch.get_rng_state()}
        if self.device == "cuda":
            state["random_cuda"] = torch.cuda.get_rng_state()
        return state

    def restore(self, state):
        """Continues from state(). On a CPU the weights become the same to the byte."""
        self.steps = state["steps"]
        self.model.load_state_dict(state["model"])
        self.average.load_state_dict(state["average"])
        self.optimiser.load_state_dict(state["optimiser"])
        for group in self.optimiser.param_groups:
            group["lr"] = self.rate
        torch.set_rng_state(state["random"])
        if self.device == "cuda":
            for of_weight in self.optimiser.state.values():  # a graph reads the GPU's memory only
                of_weight["step"] = of_weight["step"].to(self.device)
            torch.cuda.set_rng_state(state["random_cuda"])


class Checkpoint:
    """State of an interrupted training, in a file beside the weights.

    settings: what a continued training must share with the interrupted one.
    """

    def __init__(self, path, settings):
        self.path, self.settings = path, settings

    def write(self, training, progress):
        save_state({"settings": self.settings, "progress": progress,
                    "training": training.state()}, self.path)

    def read(self):
        """Exits if the file is not a checkpoint, or one of other settings."""
        try:
            saved = torch.load(self.path, map_location="cpu")
            settings = saved["settings"]
        except Exception as problem:  # of a damaged file torch.load raises errors of many types
            sys.exit(f"{self.path}: not a checkpoint of this program: {problem}")
        for name, value in self.settings.items():
            if settings.get(name) != value:
                sys.exit(f"{self.path}: made with {name} {settings.get(name)}, not {value}: "
                         "give the same options, or leave out --resume to start over")
        return saved

    def remove(self):
        if os.path.exists(self.path):
            os.remove(self.path)


def save_state(state, path):
    """By torch.save; the file appears when it is complete."""
    torch.save(state, path + ".partial")
    os.replace(path + ".partial", path)
