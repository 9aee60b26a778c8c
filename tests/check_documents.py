#!/usr/bin/env python3
"""What the documents say exists.

Usage: check_documents.py [--ossa COMMAND]

In every tracked .md file: relative links lead to tracked files, anchors to headings, and what stands
in `...` like a path of this repository is one (wildcards must match something). In every tracked text
file: no document is cited that is not in the repository. With --ossa, every `ossa NAME` of the documents
is a subcommand and every --option of their fenced command lines stands in its --help.
"""
import argparse
import fnmatch
import pathlib
import re
import subprocess
import sys

TOP = pathlib.Path(__file__).resolve().parent.parent
LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)\)")
CODE = re.compile(r"`([^`\n]+)`")
HEADING = re.compile(r"^#{1,6}\s+(.*?)\s*#*$")
FENCE = re.compile(r"^\s*```(\w*)")
FOLDERS = ("depth", "forest", "recon", "physics", "tools", "tests", "cmake", "docs", ".ci")
PATH = re.compile(rf"^(?!depth/\d|.*NAME)(?:{'|'.join(map(re.escape, FOLDERS))})/[\w./*{{}},-]+$")
# Documents outside the repository, which its readers do not have.
ELSEWHERE = re.compile(r"\b(?:DESIGN|FACTS|STYLE)\b(?!\.md)")
DOCUMENT = re.compile(r"(?<![\w/.*{}$-])((?:[\w-]+/)*[\w-]+\.md)\b")
# Limits of length: words of README.md, bytes of the release notes.
MOST_WORDS = {"README.md": 1000}
MOST_BYTES = {"CHANGES.md": 8000}
MADE = {"TABLE.md"}  # written by commands


def tracked():
    listed = subprocess.run(["git", "-C", TOP, "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
                            capture_output=True, check=True)
    return {name for name in listed.stdout.decode().split("\0") if name and (TOP / name).is_file()}


def slug(heading):
    """The anchor of a heading, as GitHub and MkDocs make it."""
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).replace("`", "").replace("*", "").lower()
    return re.sub(r"\s", "-", re.sub(r"[^\w\s-]", "", text).strip())


def blocks_of(text):
    """(line number, language or None outside of fences, line)."""
    language = None
    for number, line in enumerate(text.splitlines(), 1):
        fence = FENCE.match(line)
        if fence:
            language = fence.group(1) if language is None else None
            continue
        yield number, language, line


def anchors_of(text):
    found = set()
    for _, language, line in blocks_of(text):
        heading = HEADING.match(line) if language is None else None
        if heading:
            found.add(slug(heading.group(1)))
        found.update(re.findall(r'<a (?:id|name)="([^"]+)"', line))
    return found


def broken_links(name, text, files):
    for number, language, line in blocks_of(text):
        if language is not None:
            continue
        for target in LINK.findall(re.sub(r"`[^`]*`", "", line)):
            if re.match(r"[a-z]+:", target):
                continue
            path, _, anchor = target.partition("#")
            place = (TOP / name).parent / path if path else TOP / name
            try:
                relative = place.resolve().relative_to(TOP).as_posix()
            except ValueError:
                yield f"{name}:{number}: {target} leads out of the repository"
                continue
            if not place.exists() or (place.is_file() and relative not in files):
                yield f"{name}:{number}: {target} is not there"
            elif anchor and place.suffix == ".md" and anchor not in anchors_of(place.read_text()):
                yield f"{name}:{number}: {target}: no heading of that name"


def exists(path, files):
    folders = {parent.as_posix() for name in files for parent in pathlib.PurePosixPath(name).parents}
    plain = path.rstrip("/")
    return plain in files or plain in folders or any(fnmatch.fnmatch(name, plain) for name in files)


def missing_paths(name, text, files):
    for number, language, line in blocks_of(text):
        words = CODE.findall(line) if language is None else re.findall(r"\S+", line.split("#")[0]) if language == "sh" else []
        for word in words:
            word = word.strip("\"'();,").split(":")[0] if language else word.split(":")[0]
            if PATH.match(word) and not exists(word, files):
                yield f"{name}:{number}: there is no {word}"


def foreign_citations(name, text, files):
    if name in ("tests/check_documents.py",):
        return
    for number, line in enumerate(text.splitlines(), 1):
        if ELSEWHERE.search(line):
            yield f"{name}:{number}: cites a document that is not in the repository: {ELSEWHERE.search(line).group()}"
        for document in DOCUMENT.findall(line):
            known = any(file == document or file.endswith("/" + document) for file in files)
            if not known and document.split("/")[-1] not in MADE and "://" not in line:
                yield f"{name}:{number}: cites a document that is not in the repository: {document}"


def too_long(name, text):
    if len(text.split()) > MOST_WORDS.get(name, len(text)):
        yield f"{name}: {len(text.split())} words, at most {MOST_WORDS[name]}"
    if len(text.encode()) > MOST_BYTES.get(name, len(text.encode())):
        yield f"{name}: {len(text.encode())} bytes, at most {MOST_BYTES[name]}"


def help_of(ossa, *arguments):
    return subprocess.run([ossa, *arguments, "--help"], capture_output=True, text=True).stdout


def command_lines(text):
    """(line number, command line) of fenced sh blocks, continued lines joined, comments left out."""
    whole, first = "", 0
    for number, language, line in blocks_of(text):
        if language != "sh":
            continue
        first = first if whole else number
        whole += re.sub(r"(^|\s)#.*", "", line)
        if whole.endswith("\\"):
            whole = whole[:-1] + " "
            continue
        yield first, whole
        whole = ""


def wrong_commands(name, text, ossa, helps):
    def known(command):
        if command not in helps:
            helps[command] = set(re.findall(r"(?<![\w-])--?[\w-]+", help_of(ossa, command)))
        return helps[command]

    said = [(number, part) for number, line in command_lines(text) for part in re.split(r"\||;|&&|\$\(", line)]
    for number, language, line in blocks_of(text):
        if language is None:
            said += [(number, code) for code in CODE.findall(line)]
    for number, words in said:
        match = re.match(r"\s*(?:[\w/.-]*/)?ossa ([a-z][a-z-]*)(?![\w.=/-])(.*)", words)
        if not match:
            continue
        command = match.group(1)
        if command not in helps["commands"]:
            yield f"{name}:{number}: ossa has no command {command}"
            continue
        for option in re.findall(r"(?<=\s)--[a-z][\w-]*", match.group(2)):
            if option not in known(command):
                yield f"{name}:{number}: ossa {command} has no option {option}"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--ossa", help="the command, to hold the documents' command lines against")
    arguments = parser.parse_args()
    files, found = tracked(), []
    helps = {}
    if arguments.ossa:
        helps["commands"] = set(re.findall(r"^  ([a-z][a-z-]*) +", help_of(arguments.ossa), re.M))
        if not helps["commands"]:
            print(f"{arguments.ossa} --help names no commands")
            return 1
        helps["commands"].add("help")
    for name in sorted(files):
        try:
            text = (TOP / name).read_text(encoding="utf-8")
        except UnicodeDecodeError:
            continue
        found += foreign_citations(name, text, files)
        if not name.endswith(".md"):
            continue
        found += broken_links(name, text, files)
        found += too_long(name, text)
        found += missing_paths(name, text, files)
        if arguments.ossa:
            found += wrong_commands(name, text, arguments.ossa, helps)
    print("\n".join(found)) if found else None
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
