"""Training people of the pose network: folders of crops that `ossa crop` writes."""
import os
import sys

import numpy
import torch

FEWEST_JOINTS = 10    # with truth, of a person to learn from; chosen by hand
FOLDERS_A_BATCH = 16  # from which a batch is drawn; chosen by hand


class People:
    """All crops read so far: in the memory of a GPU, otherwise on disk until they are read.

    Folders without joints.npy are incomplete; they are an error unless `watch`, the process that
    completes them, is given.
    """

    def __init__(self, folders, device, watch):
        self.waiting, self.device, self.watch = list(folders), device, watch
        self.folders, self.crops, self.joints, self.count = [], [], [], 0
        self.read()

    def read(self):
        """Adds the folders that are complete now."""
        for folder in list(self.waiting):
            if os.path.exists(os.path.join(folder, "joints.npy")):
                self.add(folder)
                self.waiting.remove(folder)
        if self.waiting and not self.watch:
            sys.exit(f"{self.waiting[0]}: expected joints.npy, found none")

    def add(self, folder):
        on_disk = "r" if self.device == "cpu" else None
        crops = numpy.load(os.path.join(folder, "crops.npy"), mmap_mode=on_disk)
        joints = numpy.load(os.path.join(folder, "joints.npy"))
        known = numpy.flatnonzero(numpy.isfinite(joints).all(-1).sum(-1) >= FEWEST_JOINTS)
        if self.device == "cpu":
            self.crops.append((crops, known))
        else:
            self.crops.append((torch.from_numpy(crops[known]).to(self.device), None))
        self.joints.append(torch.from_numpy(joints[known]).to(self.device))
        self.folders.append(folder)
        self.count += len(known)

    def take(self, part, which):
        """Crops and joints of some people of a folder."""
        crops, known = self.crops[part]
        if known is not None:
            return torch.from_numpy(crops[known[which.numpy()]]), self.joints[part][which]
        return crops[which], self.joints[part][which]

    def batch(self, size):
        """Random crops and joints: a few folders by their sizes, then as many people of each."""
        sizes = torch.tensor([float(len(joints)) for joints in self.joints])
        few = min(FOLDERS_A_BATCH, size)
        parts = torch.multinomial(sizes, few, replacement=True).tolist()
        taken = [self.take(part, torch.randint(len(self.joints[part]), (size // few,),
                                               device=self.device)) for part in parts]
        return torch.cat([crops for crops, _ in taken]), torch.cat([joints for _, joints in taken])


def read_validation(folders, device):
    """People to validate on; each folder must have some."""
    people = People(folders, device, None)
    for folder, joints in zip(folders, people.joints):
        if len(joints) == 0:
            sys.exit(f"{folder}: expected people of {FEWEST_JOINTS} known joints, found none")
    return people
