"""Evaluates a forest on labelled images that it was not trained on, and shows where it errs.

Usage: evaluate_a_forest.py MODEL.ossa DATASET OUT.png    DATASET: a folder made by `ossa render`
"""

import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import ossa

model, dataset, out = sys.argv[1:]
numbers = ossa.evaluate(model, dataset, every=8)
print(f"{numbers['frames']} images: {numbers['pixel_accuracy']:.1%} of pixels are labelled right,")
print(f"mean average precision of joints within 10 cm {numbers['map_10cm']:.3f}")

# The same forest by hand, on the person's pixels of the first image.
depth_mm, camera, _ = next(ossa.open(dataset))
labels = plt.imread(min(pathlib.Path(dataset, "parts").glob("*.png")))
truth = np.round(labels * 255).astype(np.uint8)  # matplotlib reads 8 bits as 0 to 1
person = (truth > 0) & (truth <= 31)
parts, probabilities = ossa.Forest(model).classify(depth_mm, camera, person)
print(f"first image: {(parts == truth)[person].mean():.1%}")

figure, axes = plt.subplots(1, 3, figsize=(12, 4))
for axis, (title, image) in zip(axes, {"truth": truth * person, "forest": parts}.items()):
    axis.imshow(image, cmap="nipy_spectral", vmin=0, vmax=31)
    axis.set_title(title)
axes[2].imshow(np.where(person, probabilities.max(-1), np.nan), vmin=0, vmax=1)
axes[2].set_title("how sure it is")
v, u = np.nonzero(person)
for axis in axes:
    axis.set(xlim=(u.min() - 10, u.max() + 10), ylim=(v.max() + 10, v.min() - 10))
figure.savefig(out, dpi=120)
