#!/usr/bin/env python3
"""Every numeric constant states its unit and its origin.

Usage: check_constants.py [--list] [FILE...]   (all sources of the modules without FILE)

A constant is `constexpr TYPE kName = ...;` of an arithmetic type, or a numeric default member of a
struct named *Options, *Constants, *Traits, *Parameters or *Thresholds. Free of the rule are 0 and
what is computed from other constants, types and whole numbers alone (`2 * kJointCount - 1`): it has
their origin.

Its comment is the text beside it, the comment lines directly below that go on with it, and the block
directly above it or above the run of constants (no blank line, no other code) that it stands in.

Unit     a suffix of the name (kStep_m, rate_hz), or a word of UNITS in the comment. Whole numbers
         count what their name says and need none.
Origin   a word of ORIGINS in the comment: a paper with its year or an equation, a derivation,
         anthropometry, a standard, a format or protocol, or how the number was chosen: "chosen on
         VALIDATION DATA by COMMAND", "measured on ...", "by hand" where nobody varied it.
         A comment that begins with "Constants:" holds for all constants of its file, its unit and its
         origin for those that name none. Names that end in Version, Magic or Signature are of a format, names like
         kMetresPerMillimetre are definitions and need neither.
"""
import pathlib
import re
import subprocess
import sys

MODULES = ("depth", "forest", "recon", "physics", "tools")

WHOLE = r"(?:unsigned(?: int| long)?|int|long|size_t|std::size_t|(?:std::)?u?int\d+_t|std::streamoff|(?:std::)?ptrdiff_t)"
NUMBER = rf"(?:{WHOLE}|float|double|auto)"
CONSTANT = re.compile(rf"^\s*(?:(?:static|inline)\s+)*constexpr\s+({NUMBER})\s+(k[A-Z]\w*\s*[={{(].*)$")
STRUCT = re.compile(r"^\s*struct\s+\w*(?:Options|Constants|Traits|Parameters|Thresholds)\b[^;]*\{\s*(?://.*)?$")
MEMBER = re.compile(rf"^\s*({NUMBER})\s+(\w+\s*[={{].*)$")
# Declarators of one declaration: name and initialiser.
DECLARATOR = re.compile(r"(\w+)\s*(?:=\s*|(?=\{))((?:\{[^{}]*\}|\([^()]*(?:\([^()]*\)[^()]*)*\)|[^,;{}()])+)")
LITERAL = re.compile(r"(?<![\w.])(0[xX][0-9a-fA-F']+|(?:\d[\d']*\.?[\d']*|\.\d+)(?:[eE][-+]?\d+)?)[uUlLfFzZ]*")
NAMED = re.compile(r"\bk[A-Z]\w*|numeric_limits|\bsizeof\b")

UNIT_SUFFIX = re.compile(
    r"_(?:mm|cm|m|km|px|px_m|s|ms|us|ns|hz|fps|rad|deg|kg|n|nm|j|w|m2|mm2|kg_m2|m_s|m_s2|bytes|mb|percent|pixels?|frames?|"
    r"1_m|(?:\w+_)?per_\w+)$", re.I)
UNITS = re.compile(
    r"(?<![\w'])(?:metres?|millimetres?|centimetres?|decimetres?|mm|cm|m|m2|m/s(?:\^?2|²)?|m\^2|seconds?|s|ms|milliseconds?|"
    r"minutes?|hours?|days?|frames?|pixels?|px|cells?|Hz|radians?|rad|degrees?|kilograms?|kg|newtons?|bytes?|kB|MB|GB|bits?|"
    r"percent|shares?|fractions?|ratios?|factors?|times|probabilit(?:y|ies)|odds|log-odds|logarithms?|weights?|confidences?|scores?|"
    r"no unit|standard deviations?|cosines?|sines?|exponents?|half|halves|third|quarter|twice|1/m|1/s|correlations?|"
    r"variances?|densit(?:y|ies)|turns)(?!\w)|[%°]", re.I)
ORIGINS = re.compile(
    r"\b(?:\w+(?: et al\.?)?,? \(?(?:1[89]|20)\d\d\)?|eqs?\. ?\d+|sec\. ?[\dIVX]+|section|tables?|figs?\. ?\d+|figures?|algorithm \d|the papers?|"
    r"chosen|measured|fitted|by hand|by eye|definition|conventions?|derived|follows|so that|because|anthropometr\w+|"
    r"standards?(?! deviation)|formats?|protocols?|specification|data ?sheet|OpenNI2?|libfreenect|Embree|ODE|glTF|PNG|BVH|C3D|TRC|"
    r"Kinect v[12]|Kinect SDK|SDKs?|PrimeSense|cache lines?|registers?|SSE2?|AVX2?|AVX-512|rounding|bounds?|for speed)\b|§", re.I)
OF_FILE = re.compile(r"\bConstants: ")
CONVERSION = re.compile(r"kDegree$|k(?:Kilo|Milli|Micro|Nano|Centi|Deci)?(?:[Mm]etres?|[Ss]econds?|Degrees?|Radians?|Inch)Per[A-Z]\w*$")
FORMAT_NAME = re.compile(r"(?:Version|Magic|Signature)\d*$")


def split_comment(line):
    """A line's code and its comment; a // inside a string is no comment."""
    in_string = False
    for i, character in enumerate(line):
        if character == '"' and (i == 0 or line[i - 1] != "\\"):
            in_string = not in_string
        if not in_string and line.startswith("//", i):
            return line[:i], line[i:].lstrip("/<! ")
    return line, ""


def needs_origin(initialiser):
    """0 and whole-number arithmetic on other constants need none."""
    literals = [text.replace("'", "") for text in LITERAL.findall(initialiser)]
    if NAMED.search(initialiser):
        literals = [text for text in literals if not re.fullmatch(r"\d+|0[xX][0-9a-fA-F]+", text)]
    return any(not re.fullmatch(r"0*\.?0*", text) for text in literals)


def constants_of(lines):
    """(line number, type, name, initialiser, comment) of every constant of a file."""
    split = [split_comment(line) for line in lines]
    above, run, struct_depth = [], False, None
    depth = 0
    i = 0
    while i < len(lines):
        code, comment = split[i]
        first = i
        if not code.strip():
            above = (above if above and not run else []) + [comment] if comment else []
            run = False if comment or not code.strip() else run
            i += 1
            continue
        if STRUCT.match(code) and struct_depth is None:
            struct_depth = depth
        match = CONSTANT.match(code)
        if not match and struct_depth is not None and depth == struct_depth + 1:
            match = MEMBER.match(code)
        if match:
            text, beside = match.group(2), [comment]
            while ";" not in text and i + 1 < len(lines):
                i += 1
                text += " " + split[i][0].strip()
                beside.append(split[i][1])
            # Comment lines that go on below, indented as the comment is.
            column = lines[i].find("//")
            while (column > 0 and split[i][1] and i + 1 < len(lines) and not split[i + 1][0].strip()
                   and lines[i + 1].find("//") == column):
                i += 1
                beside.append(split[i][1])
            for name, initialiser in DECLARATOR.findall(text.split(";")[0]):
                yield first + 1, match.group(1), name, initialiser, " ".join(above + beside)
            run = True
        else:
            above, run = [], False
        for line_code, _ in split[first:i + 1]:
            bare = re.sub(r'"(?:\\.|[^"\\])*"|\'(?:\\.|[^\'\\])\'', "", line_code)
            depth += bare.count("{") - bare.count("}")
        if struct_depth is not None and depth <= struct_depth and not STRUCT.match(code):
            struct_depth = None
        i += 1


def comment_of_file(lines):
    """The text after "Constants: " in the comments of a file."""
    comments = [comment if not code.strip() else "" for code, comment in map(split_comment, lines)]
    text = ""
    for i, comment in enumerate(comments):
        if OF_FILE.search(comment):
            text += " " + comment[OF_FILE.search(comment).end():]
            while i + 1 < len(comments) and comments[i + 1]:
                i += 1
                text += " " + comments[i]
    return text


def faults_of(lines):
    """(line number, name, what is missing) of every constant that does not comply."""
    of_file = comment_of_file(lines)
    for number, kind, name, initialiser, comment in constants_of(lines):
        if not needs_origin(initialiser) or CONVERSION.match(name):
            continue
        whole = re.fullmatch(WHOLE, kind) is not None
        missing = []
        if not whole and not FORMAT_NAME.search(name) and not UNIT_SUFFIX.search(name) and not UNITS.search(comment + " " + of_file):
            missing.append("unit")
        if not ORIGINS.search(comment + " " + of_file) and not FORMAT_NAME.search(name):
            missing.append("origin")
        if missing:
            yield number, name, " and ".join(missing)


def main():
    top = pathlib.Path(__file__).resolve().parent.parent
    options = {argument for argument in sys.argv[1:] if argument.startswith("--")}
    if options - {"--list"}:
        print(__doc__)
        return 2
    named = [argument for argument in sys.argv[1:] if not argument.startswith("--")]
    files = named or subprocess.run(["git", "-C", top, "ls-files", "*.h", "*.cpp"], capture_output=True, text=True,
                                    check=True).stdout.split()
    found, total = {}, 0
    for path in files:
        module = path.split("/")[0]
        if module not in MODULES and not named:
            continue
        lines = (top / path).read_text().splitlines()
        total += sum(1 for _ in constants_of(lines))
        for number, name, missing in faults_of(lines):
            found.setdefault(module, []).append(f"{path}:{number}: {name} says no {missing}")
    if named or "--list" in options:
        print("\n".join(line for module in sorted(found) for line in found[module]))
    if named:
        return 1 if found else 0
    counts = {module: len(found.get(module, [])) for module in MODULES}
    if "--list" in options:
        print(f"{sum(counts.values())} of {total} constants do not comply: {counts}")
    for module in MODULES:
        if counts[module]:
            print(f"{module}: {counts[module]} constants say no unit or origin (see tests/check_constants.py and its --list)")
    if total < 100:
        print(f"expected the project's constants, found {total}")
    return 1 if any(counts.values()) or total < 100 else 0


if __name__ == "__main__":
    sys.exit(main())
