"""The pose network in PyTorch: its layers, input, outputs and loss.

What the network reads and how its outputs are decoded is fixed in recon/refine/person_crop.h and
recon/refine/pose_network.h. Needs PyTorch 1.13 or later.
"""
import torch
from torch import nn
from torch.nn import functional

# As in recon/refine/person_crop.h and pose_network.h.
SIDE = 96         # cells
CELL_M = 0.025
JOINTS = 20
MIRRORED = [0, 1, 2, 3, 8, 9, 10, 11, 4, 5, 6, 7, 16, 17, 18, 19, 12, 13, 14, 15]
DEPTH_SCALE = 2.0  # inputs a metre
OFFSET_M = 0.2     # of an output of 1
OUTPUTS = 5        # of each joint: vote, offset (3), logarithm of the error's scale


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
