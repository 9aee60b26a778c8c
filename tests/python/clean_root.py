"""What a wheel must do on a machine without any other part of ossa."""

import pathlib

import numpy as np

import ossa

libraries = pathlib.Path("/usr/lib/x86_64-linux-gnu")
assert not [name for name in ("OpenNI2", "ode", "glog", "tbb", "png16") if [*libraries.glob(f"lib{name}*")]]
licences = {file.name for file in pathlib.Path(ossa.__file__).parents[1].glob("ossa-*.dist-info/licenses/*")}
assert {"LICENSE", "copyright", "libode8", "libopenni2-0"} <= licences, licences
frames = list(ossa.Tracker(parts=True).run("/clip"))
assert len(frames) == 24 and len(frames[-1].bodies) == 1
sequence = ossa.Sequence.from_frames(frames)
ossa.write_skeletons(sequence, "/seen.jsonl")
ossa.write_skeletons(sequence, "/seen.glb")
assert pathlib.Path("/seen.glb").read_bytes()[:4] == b"glTF"
fitted = ossa.Tracker(fit=True).track(*next(ossa.open("/clip"))).bodies[0]
assert fitted.mesh is not None and np.isfinite(fitted.mesh.vertices).all()
assert ossa.compare("/clip/truth.jsonl", "/seen.jsonl")["results"][0]["mean_joint_error_cm"] < 6
for method in ("shum-2013", "plantard-2016", "kalman"):
    assert np.isfinite(ossa.reconstruct(sequence[:5], method).joints).all()
assert ossa.Tracker(physics=True).track(*next(ossa.open("/clip"))).bodies
model = pathlib.Path(ossa.__file__).parent / "share/ossa/body.ossa"
assert ossa.evaluate(model, "/clip", every=12)["pixel_accuracy"] > 0.5
try:
    ossa.open("openni:")
except ossa.InputError as error:
    assert "device" in str(error), error
print("ossa", ossa.__version__, "tracks in a clean root")
