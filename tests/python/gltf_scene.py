"""A .glb as pygltflib and NumPy see it: nodes posed at a time, skins by linear-blend skinning."""

import numpy as np

COMPONENTS = {5121: np.uint8, 5123: np.uint16, 5126: np.float32}
WIDTHS = {"SCALAR": 1, "VEC3": 3, "VEC4": 4, "MAT4": 16}
PLACES = {"translation": 0, "rotation": 1, "scale": 2}


class Scene:
    def __init__(self, pygltflib, path):
        self.gltf = pygltflib.GLTF2().load(str(path))
        self.blob = self.gltf.binary_blob()
        self.names = [node.name for node in self.gltf.nodes]
        motion = self.gltf.animations[0]
        self.tracks = [
            (channel.target.node, PLACES[channel.target.path], self.numbers(sampler.input)[:, 0],
             self.numbers(sampler.output), sampler.interpolation)
            for channel in motion.channels for sampler in [motion.samplers[channel.sampler]]
        ]  # fmt: skip

    def numbers(self, accessor):
        a = self.gltf.accessors[accessor]
        view = self.gltf.bufferViews[a.bufferView]
        begin = (view.byteOffset or 0) + (a.byteOffset or 0)
        values = np.frombuffer(self.blob, COMPONENTS[a.componentType], a.count * WIDTHS[a.type], begin)
        return values.reshape(a.count, -1)

    def rest(self):
        return [
            [np.array(node.translation or [0, 0, 0]), np.array(node.rotation or [0, 0, 0, 1]),
             np.array(node.scale or [1, 1, 1])]
            for node in self.gltf.nodes
        ]  # fmt: skip

    def world(self, time_s=None):
        """float64 [nodes, 4, 4]: global transforms at a time; at rest without one."""
        local = self.rest()
        for node, place, times, values, kind in self.tracks if time_s is not None else ():
            local[node][place] = between(times, values, time_s, kind, place == 1)
        made = np.zeros((len(local), 4, 4))

        def walk(node, parent):
            made[node] = parent @ matrix(*local[node])
            for child in self.gltf.nodes[node].children or ():
                walk(child, made[node])

        for root in self.gltf.scenes[0].nodes:
            walk(root, np.eye(4))
        return made

    def person(self, body_id):
        """Bone name -> number of its node, of the person of that id."""
        made = {}

        def walk(node):
            made[self.names[node]] = node
            for child in self.gltf.nodes[node].children or ():
                walk(child)

        walk(self.names.index(f"person {body_id}"))
        return made

    def skin(self, index, world):
        """Vertices float64 [V, 3] as the nodes carry them, and triangles [F, 3]."""
        skin = self.gltf.skins[index]
        node = next(n for n in self.gltf.nodes if n.skin == index)
        primitive = self.gltf.meshes[node.mesh].primitives[0]
        inverse = self.numbers(skin.inverseBindMatrices).reshape(-1, 4, 4).transpose(0, 2, 1)
        moves = world[skin.joints] @ inverse
        vertices = self.numbers(primitive.attributes.POSITION)
        weights = self.numbers(primitive.attributes.WEIGHTS_0)
        bones = self.numbers(primitive.attributes.JOINTS_0)
        placed = np.concatenate([vertices, np.ones((len(vertices), 1))], axis=1)
        posed = np.einsum("vk,vkij,vj->vi", weights, moves[bones], placed)
        return posed[:, :3], self.numbers(primitive.indices).reshape(-1, 3)


def between(times, values, time_s, kind, is_turn):
    i = int(np.clip(np.searchsorted(times, time_s, side="right") - 1, 0, len(times) - 1))
    if kind == "STEP" or i + 1 == len(times) or time_s <= times[i]:
        return values[i].astype(float)
    mix = (time_s - times[i]) / (times[i + 1] - times[i])
    mixed = (1 - mix) * values[i] + mix * values[i + 1]
    return mixed / np.linalg.norm(mixed) if is_turn else mixed


def matrix(translation, rotation, scale):
    x, y, z, w = rotation
    made = np.eye(4)
    made[:3, :3] = np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]) * scale  # fmt: skip
    made[:3, 3] = translation
    return made
