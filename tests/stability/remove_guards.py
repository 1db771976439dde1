#!/usr/bin/python3
"""Removes each guard that a stability test stands for, one at a time, and sees that the test then fails.

A guard is an entry of tests/stability/guards/NAME.json, NAME that of the test's file: the exact text of a source file, which
occurs once in it, and what stands there without the guard. The edits are made in a copy of the working tree, in build-guards/
(kept, so that a second run is short), and only lanewise_tests is built. Exit code 1 if a test passes without its guard, if an
entry does not apply or build, or if a test fails with all guards in place.

    tests/stability/remove_guards.py --out perf/results/guards.md
    tests/stability/remove_guards.py slab watertight
    tests/stability/remove_guards.py --check          # only whether every entry applies: seconds, no build
"""

import argparse
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
GUARDS = ROOT / "tests" / "stability" / "guards"
TREE = ROOT / "build-guards" / "tree"
BUILD = TREE / "build"


def load(names):
    """All entries, or those of these files, each with the name of its file."""
    paths = [GUARDS / f"{name}.json" for name in names] or sorted(GUARDS.glob("*.json"))
    return [dict(entry, name=path.stem) for path in paths for entry in json.loads(path.read_text())]


def applies(entry):
    source = ROOT / entry["file"]
    return source.is_file() and source.read_text().count(entry["replace"]) == 1 and entry["with"] != entry["replace"]


def copy_tree():
    """Makes TREE what the working tree is, touching only files that differ."""
    listed = subprocess.run(["git", "ls-files", "-coz", "--exclude-standard"], cwd=ROOT, check=True, capture_output=True)
    files = {name for name in listed.stdout.decode().split("\0") if name and (ROOT / name).is_file()}
    for old in TREE.rglob("*"):
        if old.is_file() and BUILD not in old.parents and str(old.relative_to(TREE)) not in files:
            old.unlink()
    for name in files:
        source, target = ROOT / name, TREE / name
        if target.is_file() and target.read_bytes() == source.read_bytes():
            continue
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(source, target)


def build():
    """Whether lanewise_tests builds; what the compiler says goes to build.log."""
    with open(BUILD / "build.log", "w") as log:
        command = ["cmake", "--build", str(BUILD), "--target", "lanewise_tests"]
        return subprocess.run(command, stdout=log, stderr=log).returncode == 0


def run(pattern, seconds):
    """(test cases that ran, what became of them: "pass", "fails", "crashes" or "hangs")."""
    environment = dict(os.environ, LANEWISE_BINARY=str(BUILD / "lanewise"), LANEWISE_SOURCE_DIR=str(TREE))
    environment.pop("LANEWISE_STABILITY_CURVES", None)
    command = [str(BUILD / "lanewise_tests"), f"-tc={pattern}"]
    try:
        result = subprocess.run(command, cwd=BUILD, env=environment, capture_output=True, text=True, errors="replace",
                                timeout=seconds)
    except subprocess.TimeoutExpired:
        return 1, "hangs"
    counts = re.search(r"test cases:\s*(\d+)", result.stdout)
    if not counts or result.returncode < 0:
        return 1, "crashes"
    return int(counts[1]), "fails" if result.returncode else "pass"


def without(entry, seconds):
    """What the entry's test does without its guard."""
    target = TREE / entry["file"]
    source = target.read_text()
    target.write_text(source.replace(entry["replace"], entry["with"]))
    try:
        if not build():
            return f"DOES NOT BUILD, see {BUILD / 'build.log'}"
        outcome = run(entry["test"], seconds)[1]
        return "STILL PASSES" if outcome == "pass" else f"{outcome}, as it must"
    finally:
        target.write_text(source)


def table(entries):
    lines = ["# Every stability test fails when its guard is removed", "",
             "Made by `tests/stability/remove_guards.py --out perf/results/guards.md`: each guard is taken out of a copy of the "
             "source, alone, and the test is run.", "",
             "| failure mode | guard | file | test | without the guard |", "|---|---|---|---|---|"]
    for e in entries:
        lines.append(f"| {e['name']} | {e['why']} | `{e['file']}` | `{e['test']}` | {e['result']} |")
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", help="guards/NAME.json; default: all")
    parser.add_argument("--check", action="store_true", help="only whether every entry applies")
    parser.add_argument("--out", type=pathlib.Path, help="write the table here")
    parser.add_argument("--timeout", type=float, default=300, help="seconds after which a test hangs [300]")
    options = parser.parse_args()

    entries = load(options.names)
    stale = [e for e in entries if not applies(e)]
    for e in stale:
        print(f"{e['name']}: the text to replace does not occur once in {e['file']}: {e['replace']!r}", file=sys.stderr)
    if options.check or stale:
        print(f"{len(entries)} guards, {len(stale)} that do not apply")
        return 1 if stale else 0

    copy_tree()
    configure = ["cmake", "-G", "Ninja", "-S", str(TREE), "-B", str(BUILD), "-DCMAKE_BUILD_TYPE=Release", "-DLANEWISE_PERF=OFF"]
    subprocess.run(configure, check=True, stdout=subprocess.DEVNULL)
    if not build():
        sys.exit(f"the tree does not build: {BUILD / 'build.log'}")
    with_guards = {pattern: run(pattern, options.timeout) for pattern in {e["test"] for e in entries}}
    broken = [pattern for pattern, (cases, outcome) in with_guards.items() if cases == 0 or outcome != "pass"]
    if broken:
        sys.exit("no such test, or it fails with every guard in place: " + ", ".join(broken))

    for e in entries:
        e["result"] = without(e, options.timeout)
        print(f"{e['name']}: without \"{e['why']}\", {e['test']}: {e['result']}", flush=True)
    if options.out:
        options.out.parent.mkdir(parents=True, exist_ok=True)
        options.out.write_text(table(entries))
    return 0 if all(e["result"].endswith("as it must") for e in entries) else 1


if __name__ == "__main__":
    sys.exit(main())
