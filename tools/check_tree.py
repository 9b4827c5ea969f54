#!/usr/bin/env python3
"""Holds the shape of the tree: which folder may include which, headers that stand alone, files of a readable size, no
unfinished work, no test that is off in silence. Prints every violation; exit code 1 if there is one.

    tools/check_tree.py                     the quick rules
    tools/check_tree.py --headers           also compiles every header alone (needs the compiler)
"""
import argparse
import concurrent.futures
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent

# A folder of src/ and what it may include, itself aside (docs/architecture.md).
LAYERS = {
    "base": set(),
    "math": {"base"},
    "parallel": {"base"},
    "geometry": {"math", "base"},
    "accel": {"geometry", "parallel", "math", "base"},
    "scene": {"geometry", "math", "base"},
    "io": {"scene", "geometry", "math", "base"},
    "render": {"accel", "scene", "geometry", "parallel", "math", "base"},
    "cluster": {"render", "accel", "scene", "geometry", "parallel", "math", "base"},
    "app": {"cluster", "render", "io", "accel", "scene", "geometry", "parallel", "math", "base"},
    "python": {"cluster", "render", "io", "accel", "scene", "geometry", "parallel", "math", "base"},
}

# Libraries that only these places may see: header prefix -> folders or files of src/.
LIBRARIES = {
    "embree3/": ["accel/"],
    "tbb/": ["parallel/"],
    "oneapi/tbb": ["parallel/"],
    "OpenImageIO/": ["io/"],
    "assimp/": ["io/"],
    "draco/": ["io/"],
    "png.h": ["io/"],
    "nlohmann/": ["io/", "app/"],
    "CLI/": ["app/"],
    "spdlog/": ["app/"],
    "boost/": ["app/server/"],
    "turbojpeg.h": ["app/server/"],
    "xxhash.h": ["base/", "io/"],
}

LONGEST = 500
# Files that may be longer, each with the reason.
LONG_FILES: dict[str, str] = {
    "src/accel/embree.cpp": "building and asking one Embree scene: the margins of both halves belong together",
}

UNFINISHED = re.compile(r"\b(TODO|FIXME|XXX|HACK)\b(?!\w)")
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.M)
DISABLED = re.compile(r"\bTEST(?:_F|_P)?\s*\(\s*(\w+)\s*,\s*(DISABLED_\w+)|\bGTEST_SKIP\(\)[ ]*(<<[^;\n]*(?:\n\s*<<[^;\n]*)*)?")


def sources(*folders):
    for folder in folders:
        for path in sorted((ROOT / folder).rglob("*")):
            if path.suffix in (".h", ".cpp"):
                yield path


def name(path):
    return str(path.relative_to(ROOT))


def check_includes(problems):
    """No include upward, none of a library outside its place, and none that is written relative to the file."""
    graph = {}
    for path in sources("src"):
        inside = path.relative_to(ROOT / "src")
        layer = inside.parts[0]
        if layer not in LAYERS:
            problems.append(f"{name(path)}: the folder '{layer}' is not in the table of layers in tools/check_tree.py")
            continue
        graph[str(inside)] = []
        for bracket, target in INCLUDE.findall(path.read_text(encoding="utf-8")):
            if bracket == '"':
                if not (ROOT / "src" / target).is_file():
                    problems.append(f"{name(path)}: includes \"{target}\", which does not exist in src/")
                    continue
                graph[str(inside)].append(target)
                above = target.split("/")[0]
                if above != layer and above not in LAYERS[layer]:
                    problems.append(f"{name(path)}: {layer} must not include {above} (\"{target}\")")
            for prefix, places in LIBRARIES.items():
                if target.startswith(prefix) and not str(inside).startswith(tuple(places)):
                    problems.append(f"{name(path)}: only {', '.join(places)} may see <{target}>")
    check_cycles(graph, problems)


def check_cycles(graph, problems):
    """Headers that include each other in a ring. scene/scene.h and scene/hierarchy.h share one template by intent."""
    allowed = {frozenset({"scene/scene.h", "scene/hierarchy.h"})}
    state = {}

    def visit(node, trail):
        state[node] = "open"
        for target in graph.get(node, []):
            if state.get(target) == "open":
                ring = trail[trail.index(target):]
                if frozenset(ring) not in allowed:
                    problems.append(f"src/{node}: includes itself through {' -> '.join(ring + [target])}")
            elif target not in state:
                visit(target, trail + [target])
        state[node] = "done"

    for node in graph:
        if node not in state:
            visit(node, [node])


def check_text(problems):
    for path in sources("src", "tests", "bench"):
        text = path.read_text(encoding="utf-8")
        lines = text.splitlines()
        if path.suffix == ".h" and not re.search(r"^#pragma once$", text, re.M):
            problems.append(f"{name(path)}: a header without #pragma once")
        if len(lines) > LONGEST and name(path) not in LONG_FILES:
            problems.append(f"{name(path)}: {len(lines)} lines; split it, or list it in LONG_FILES with the reason")
        for number, line in enumerate(lines, 1):
            if UNFINISHED.search(line):
                problems.append(f"{name(path)}:{number}: unfinished: {line.strip()}")
            if "\t" in line or line != line.rstrip():
                problems.append(f"{name(path)}:{number}: tab, or blank at the end of the line")
    for listed in LONG_FILES:
        if not (ROOT / listed).is_file():
            problems.append(f"tools/check_tree.py: LONG_FILES names {listed}, which does not exist")


def list_disabled(problems):
    """Tests that are off, or can skip themselves, are listed; one without a message is a violation."""
    listed = []
    for path in sources("tests"):
        text = path.read_text(encoding="utf-8")
        for match in DISABLED.finditer(text):
            line = text.count("\n", 0, match.start()) + 1
            place = f"{name(path)}:{line}"
            if match.group(2):
                problems.append(f"{place}: {match.group(1)}.{match.group(2)} is disabled; use GTEST_SKIP() with the reason")
            elif not match.group(3):
                problems.append(f"{place}: GTEST_SKIP() without a reason")
            else:
                listed.append(f"  {place}: {' '.join(match.group(3).split())}")
    if listed:
        print(f"{len(listed)} places where a test can skip itself:")
        print("\n".join(listed))


def check_headers(problems):
    """Every header compiles alone: it includes what it needs."""
    def compiles(path):
        command = ["c++", "-std=c++20", "-fsyntax-only", "-ffp-contract=off", f"-I{ROOT / 'src'}", f"-I{ROOT / 'tests'}", "-x", "c++", str(path)]
        result = subprocess.run(command, capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL)
        errors = [line for line in result.stderr.splitlines() if "error" in line]
        return None if result.returncode == 0 else f"{name(path)}: does not compile alone: {errors[0] if errors else result.stderr.strip()}"

    headers = [path for path in sources("src") if path.suffix == ".h"]
    with concurrent.futures.ThreadPoolExecutor(max_workers=2) as pool:
        problems.extend(problem for problem in pool.map(compiles, headers) if problem)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--headers", action="store_true", help="also compile every header alone")
    arguments = parser.parse_args()

    problems = []
    check_includes(problems)
    check_text(problems)
    list_disabled(problems)
    if arguments.headers:
        check_headers(problems)
    for problem in problems:
        print(problem)
    print(f"{len(problems)} violations" if problems else "the tree is in order")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
