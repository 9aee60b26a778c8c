"""What pip installed works: installed.py CLIP"""

import importlib.metadata
import sys

import ossa

assert "site-packages" in ossa.__file__, ossa.__file__
assert any(file.name == "LICENSE" for file in importlib.metadata.files("ossa"))
frames = list(ossa.Tracker().run(sys.argv[1]))
assert len(frames) == 24 and len(frames[-1].bodies) == 1
try:
    ossa.open("openni:")
except ossa.InputError as error:
    assert "device" in str(error), error
print(frames[-1], frames[-1].bodies[0]["Head"])
