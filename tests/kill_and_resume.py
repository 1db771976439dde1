#!/usr/bin/python3
"""Kills renders at random moments, resumes them, and sees whether the pictures have the bits of undisturbed ones.

For each scene and each mode (the same number of samples for every pixel, -a, --noise) one render is left alone and timed; then
others are killed (SIGKILL) again and again, at moments drawn uniformly from what is left of that time, and resumed until they
come to their end. Exit code 1 if any picture differs.

    tests/kill_and_resume.py --kills 200 scenes/cornell_spheres.dae scenes/cornell_metal.dae
"""

import argparse
import os
import pathlib
import random
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[1]
PROGRAM = os.environ.get("LANEWISE_BINARY", ROOT / "build" / "lanewise")
MODES = {
    "-s": ["-s", "400"],
    "-a": ["-s", "2048", "-a", "64", "0.03"],
    "--noise": ["-s", "4096", "--noise", "0.03"],
}


def command(scene, flags, output):
    return [PROGRAM, "render", scene, "-q", "-r", "240", "180", *flags, "-f", output]


def run_killed(arguments, kills, seconds, chance):
    """Kills up to so many runs. How many were killed, once the render has come to its end by itself."""
    killed = 0
    while True:
        process = subprocess.Popen(arguments)
        if killed < kills:
            try:
                process.wait(chance.uniform(0, 0.5 * seconds))
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
                killed += 1
                continue
        if process.wait() != 0:
            sys.exit(f"kill_and_resume.py: exit code {process.returncode}: {' '.join(map(str, arguments))}")
        return killed


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="+", metavar="SCENE")
    parser.add_argument("--kills", type=int, default=200, help="in all (default 200)")
    parser.add_argument("--seed", type=int, default=1)
    o = parser.parse_args()
    chance = random.Random(o.seed)
    cases = [(scene, mode) for scene in o.scenes for mode in MODES]
    done, wrong = 0, 0
    for i, (scene, mode) in enumerate(cases):
        quota = (o.kills - done + len(cases) - i - 1) // (len(cases) - i)
        killed, rounds = 0, 0
        with tempfile.TemporaryDirectory() as folder:
            want, got, checkpoint = (os.path.join(folder, name) for name in ("want.pfm", "got.pfm", "checkpoint.exr"))
            start = time.monotonic()
            subprocess.run(command(scene, MODES[mode], want), check=True)
            seconds = time.monotonic() - start
            while killed < quota:
                arguments = command(scene, MODES[mode], got)
                arguments += ["--checkpoint", checkpoint, "--every", "50ms", "--resume"]
                killed += run_killed(arguments, min(12, quota - killed), seconds, chance)
                rounds += 1
                if pathlib.Path(want).read_bytes() != pathlib.Path(got).read_bytes():
                    wrong += 1
                    print(f"{scene} {mode}: the picture differs")
                os.remove(checkpoint)
                os.remove(got)
        done += killed
        print(f"{scene} {mode}: {killed} kills in {rounds} renders of {seconds:.1f} s", flush=True)
    print(f"{done} kills, {wrong} pictures with other bits")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
