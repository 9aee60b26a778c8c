#!/usr/bin/env python3
"""The rooms of docs/architecture.md and the arrows between them, checked by reading every #include.

Usage: check_layers.py [TOP]. Prints each broken rule as FILE:LINE: reason; exit status 1 if any.
"""
import pathlib
import re
import sys

# Who may include whom; a room may always include itself.
ARROWS = {
    "depth": set(),
    "forest": {"depth"},
    "recon": {"depth"},
    "physics": {"recon", "depth"},
    "tools": {"depth", "forest", "recon", "physics"},
}
# Of the folders of tools/: what they may include of each other; those not named, whatever they like.
TOOLS = {
    "tools/people": set(),
    "tools/tracker": {"tools/people"},
}
# Inside public headers only Eigen and the standard library appear.
HIDDEN = re.compile(
    r"^(opencv|ceres/|ode/|embree|OpenNI|OniC|Driver/Oni|nlohmann/|fmt/|spdlog/|CLI/|tbb/|oneapi/|hwy/|mpi\.h|"
    r"zstd|zlib|xxhash|boost|nanoflann|libfreenect|toml)"
)
# tools/commands is the command itself, no library: nobody includes it from outside. NiTE's headers
# show OpenNI2, as NiTE's programs expect.
SHOWING = ("tools/commands/", "tools/nite2/include/")
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')


def broken_rules(top: pathlib.Path):
    folders_of = {}
    for room, allowed in ARROWS.items():
        for path in sorted((top / room).rglob("*")):
            if path.suffix not in (".h", ".cpp"):
                continue
            name = path.relative_to(top).as_posix()
            public = path.suffix == ".h" and not path.stem.endswith("_internal")
            for number, line in enumerate(path.read_text().splitlines(), 1):
                match = INCLUDE.match(line)
                if not match:
                    continue
                target = match.group(2)
                target_room = target.split("/")[0]
                if target_room in ARROWS:
                    if target_room != room and target_room not in allowed:
                        yield f"{name}:{number}: {room}/ may not include {target}"
                    if target.endswith("_internal.h") and target_room != room:
                        yield f"{name}:{number}: {target} belongs to {target_room}/ alone"
                    of_tools = "/".join(target.split("/")[:2])
                    home = "/".join(name.split("/")[:2])
                    if home in TOOLS and target_room == "tools" and of_tools not in TOOLS[home] | {home}:
                        yield f"{name}:{number}: {home}/ may not include {target}"
                    source, sink = path.parent.relative_to(top).as_posix(), str(pathlib.PurePosixPath(target).parent)
                    if source != sink:
                        folders_of.setdefault((source, sink), f"{name}:{number}")
                elif target_room == "tests":
                    yield f"{name}:{number}: the rooms may not include the tests"
                elif public and HIDDEN.match(target) and not name.startswith(SHOWING):
                    yield f"{name}:{number}: public header shows {target}"
    for (source, sink), place in folders_of.items():
        if (sink, source) in folders_of and source < sink:
            yield f"{place}: {source}/ and {sink}/ include each other (see {folders_of[(sink, source)]})"


def main() -> int:
    top = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent.parent)
    found = list(broken_rules(top.resolve()))
    for line in found:
        print(line)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
