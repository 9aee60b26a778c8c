#!/usr/bin/env python3
"""The modules of docs/architecture.md: the dependencies between them, their sizes, and the path of a frame.

Usage: check_layers.py [--sizes] [TOP]

Prints each broken rule as FILE:LINE: reason; exit status 1 if any.

Dependencies  who may include whom (DEPENDENCIES, TOOLS), read from every #include. No two folders include
              each other.
Sizes         every source file lies in a folder that docs/architecture.md lists under "Modules", and the
              largest of these has less than LARGEST of the lines. A file counts in the deepest listed folder
              that it lies in. --sizes prints them all, and the folders at the top.
Path          each step of a frame's path through the tracker is called from the list before it and from
              nowhere else (FRAME_PATH): no step calls back into an earlier one.
"""
import collections
import pathlib
import re
import sys

# Allowed includes; a module may always include itself.
DEPENDENCIES = {
    "depth": set(),
    "forest": {"depth"},
    "recon": {"depth"},
    "physics": {"recon", "depth"},
    "tools": {"depth", "forest", "recon", "physics"},
}
# Allowed includes between folders of tools/; folders that are not listed may include all.
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
# The largest module, as a share of the lines of all of them.
LARGEST = 0.20
CODE = (".h", ".cpp", ".c", ".inc", ".py", ".js", ".css", ".html")
MODULE = re.compile(r"^\| `([\w/]+)/` \|")
# The path of a frame, in order: each step and its callers. Tracker::Track calls the first two, the list
# kStages calls the steps of a person, and these call their own parts.
FRAME_PATH = {
    "DetectPeople": {"tools/tracker/track_frame.cpp"},
    "forest::Classify": {"tools/people/forest_evidence.cpp"},
    "forest::Propose": {"tools/people/forest_evidence.cpp"},
    "forest::Relabel": {"tools/people/forest_evidence.cpp"},
    "TrackSkeleton": {"tools/tracker/track_frame.cpp"},
    "ChooseRaw": {"tools/tracker/skeleton_stages.cpp"},
    "ChoosePosture": {"tools/tracker/skeleton_stages.cpp"},
    "Refine": {"tools/tracker/skeleton_stages.cpp"},
    "RefineJoints": {"tools/tracker/skeleton_stages.cpp"},
    "Fit": {"tools/tracker/skeleton_stages.cpp"},
    "FitSurface": {"tools/tracker/skeleton_stages.cpp"},
    "ApplyMode": {"tools/tracker/skeleton_stages.cpp"},
    "AverageStationary": {"tools/tracker/skeleton_stages.cpp"},
    "Reconstruct": {"tools/tracker/skeleton_stages.cpp"},
    "SmoothPosture": {"tools/tracker/skeleton_stages.cpp"},
    "StandOnFloor": {"tools/tracker/skeleton_stages.cpp"},
    "Simulate": {"tools/tracker/skeleton_stages.cpp"},
    "Finish": {"tools/tracker/skeleton_stages.cpp"},
}
FRAME_PATH_FOLDERS = ("tools/people", "tools/tracker")
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')


def broken_rules(top: pathlib.Path):
    folders_of = {}
    for module, allowed in DEPENDENCIES.items():
        for path in sorted((top / module).rglob("*")):
            if path.suffix not in (".h", ".cpp"):
                continue
            name = path.relative_to(top).as_posix()
            public = path.suffix == ".h" and not path.stem.endswith("_internal")
            for number, line in enumerate(path.read_text().splitlines(), 1):
                match = INCLUDE.match(line)
                if not match:
                    continue
                target = match.group(2)
                target_module = target.split("/")[0]
                if target_module in DEPENDENCIES:
                    if target_module != module and target_module not in allowed:
                        yield f"{name}:{number}: {module}/ may not include {target}"
                    if target.endswith("_internal.h") and target_module != module:
                        yield f"{name}:{number}: {target} belongs to {target_module}/ alone"
                    of_tools = "/".join(target.split("/")[:2])
                    home = "/".join(name.split("/")[:2])
                    if home in TOOLS and target_module == "tools" and of_tools not in TOOLS[home] | {home}:
                        yield f"{name}:{number}: {home}/ may not include {target}"
                    source, sink = path.parent.relative_to(top).as_posix(), str(pathlib.PurePosixPath(target).parent)
                    if source != sink:
                        folders_of.setdefault((source, sink), f"{name}:{number}")
                elif target_module == "tests":
                    yield f"{name}:{number}: the modules may not include the tests"
                elif public and HIDDEN.match(target) and not name.startswith(SHOWING):
                    yield f"{name}:{number}: public header shows {target}"
    for (source, sink), place in folders_of.items():
        if (sink, source) in folders_of and source < sink:
            yield f"{place}: {source}/ and {sink}/ include each other (see {folders_of[(sink, source)]})"


def listed_modules(top: pathlib.Path):
    section = (top / "docs/architecture.md").read_text().split("\n## Modules", 1)[-1].split("\n## ", 1)[0]
    return [match.group(1) for match in map(MODULE.match, section.splitlines()) if match and match.group(1) != "tests"]


def module_sizes(top: pathlib.Path):
    """Lines of each listed module, and the folders of code that are in none."""
    modules = listed_modules(top)
    sizes, homeless = collections.Counter({module: 0 for module in modules}), set()
    for module in DEPENDENCIES:
        for path in (top / module).rglob("*"):
            if path.suffix not in CODE or not path.is_file():
                continue
            folder = path.parent.relative_to(top).as_posix()
            homes = [home for home in modules if folder == home or folder.startswith(home + "/")]
            home = max(homes, key=len, default=None)
            # tools/ and recon/ only hold modules: a folder of them has a line of its own.
            if home is None or (home in DEPENDENCIES and folder != home):
                homeless.add(folder)
            else:
                sizes[home] += len(path.read_text(errors="replace").splitlines())
    return sizes, homeless


def count_lines(folder: pathlib.Path) -> int:
    files = (path for path in folder.rglob("*") if path.suffix in CODE and path.is_file())
    return sum(len(path.read_text(errors="replace").splitlines()) for path in files)


def print_sizes(top: pathlib.Path):
    sizes, _ = module_sizes(top)
    total = sum(sizes.values())
    for module, lines in sizes.most_common():
        if lines > 0:
            print(f"{lines:6} {lines / total:6.1%} {module}/")
    with_tests = total + count_lines(top / "tests")
    for module in DEPENDENCIES:
        lines = count_lines(top / module)
        print(f"{lines:6} {lines / total:6.1%} {module}/ and all below; tests counted, {lines / with_tests:.1%}")


def broken_sizes(top: pathlib.Path):
    sizes, homeless = module_sizes(top)
    for folder in sorted(homeless):
        yield f"docs/architecture.md: expected {folder}/ in the list of modules"
    total = sum(sizes.values())
    for module, lines in sizes.most_common():
        if lines >= LARGEST * total:
            yield f"{module}/: {lines} of {total} lines, at most {LARGEST:.0%}: make modules of it"


def broken_path(top: pathlib.Path):
    """Calls of a step from elsewhere; &Step and {Step, ...} of a list of stages count as calls."""
    called = collections.Counter()
    for path in sorted(source for folder in FRAME_PATH_FOLDERS for source in (top / folder).glob("*.cpp")):
        name = path.relative_to(top).as_posix()
        for number, line in enumerate(path.read_text().splitlines(), 1):
            code = line.split("//")[0]
            for step, callers in FRAME_PATH.items():
                if not re.search(rf"(?<![\w.>:]){step}\b\s*[(,}}]|(?<=people::){step}\(", code):
                    continue
                if re.match(rf"[\w:<>]+ {step}\(", code):
                    continue  # its definition
                called[step] += 1
                if name not in callers:
                    yield f"{name}:{number}: calls {step} out of turn: {' and '.join(sorted(callers))} does"
    for step in FRAME_PATH:
        if called[step] == 0:
            yield f"tests/check_layers.py: nobody calls {step}: FRAME_PATH is not the tracker's"


def main() -> int:
    arguments = [argument for argument in sys.argv[1:] if argument != "--sizes"]
    top = pathlib.Path(arguments[0] if arguments else pathlib.Path(__file__).parent.parent).resolve()
    if "--sizes" in sys.argv:
        print_sizes(top)
    found = [*broken_rules(top), *broken_sizes(top), *broken_path(top)]
    for line in found:
        print(line)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
