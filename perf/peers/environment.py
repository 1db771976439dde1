#!/usr/bin/python3
"""Compares Lanewise with Mitsuba 3 (scalar_rgb) under an environment map, through a pinhole and through a thin lens.

    perf/peers/setup                         # once: Mitsuba into build-peers/venv
    perf/peers/environment.py --quick        # a minute: one scene, few samples, nothing written
    perf/peers/environment.py                # half an hour of two cores; writes perf/results/environment.md and .json

As unbiased.py, whose rounds and tests these are. The map, 64 x 32 texels, is made here: a gradient, a sun of nine
texels, dark ground. The scenes are a shipped one and the boxes of the course with spheres, open towards the camera.

Exits with 0 if every verdict is good or if Mitsuba is not installed, which it says.
"""
import argparse
import os
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
VENV = ROOT / 'build-peers' / 'venv'
PYTHON = VENV / 'bin' / 'python'
if pathlib.Path(sys.prefix).resolve() != VENV.resolve():
    if not PYTHON.exists():
        print('environment.py: skipped, Mitsuba is not installed; perf/peers/setup installs it')
        sys.exit(0)
    os.execv(PYTHON, [PYTHON, __file__, *sys.argv[1:]])

import numpy as np  # noqa: E402

sys.path.append(str(ROOT / 'perf'))
import lanewise  # noqa: E402
import report  # noqa: E402
import unbiased  # noqa: E402
import welch  # noqa: E402

DEPTHS = [0, 1, 2, 5]
OUTDOORS = ROOT / 'scenes' / 'outdoors.dae'
LENS = 0.02  # radius over the distance in focus


def sky(width=64, height=32):
    """(height, width, 3), row 0 at the top."""
    up = np.cos(np.pi * (np.arange(height) + 0.5) / height)[:, None, None]
    picture = np.where(up > 0, np.array([0.8, 0.9, 1.0]) - up * np.array([0.6, 0.4, 0.1]), [0.15, 0.12, 0.1])
    picture = np.broadcast_to(picture, (height, width, 3)).copy()
    picture[9:12, 50:53] = [40, 36, 30]
    return picture


class Subject(unbiased.Subject):
    """A scene under the sky, flat."""

    def __init__(self, path, sky_file, lens, threads):
        super().__init__(path, 'flat', threads)
        if path == OUTDOORS:
            self.camera = self.scene.camera('file')
        self.label = 'thin lens' if lens else 'pinhole'
        self.key = f'{"lens" if lens else "pinhole"}-{unbiased.digest(sky_file)}'
        places = [s.positions.mean(0) if hasattr(s, 'positions') else s.center for s in self.scene.shapes]
        distance = float(np.linalg.norm(np.mean(places, 0) - self.camera.eye))
        self.flags = ['-e', sky_file] + (['-b', LENS * distance, '-d', distance] if lens else [])


def main():
    parser = argparse.ArgumentParser(description='Compares Lanewise with Mitsuba 3 under an environment map.')
    parser.add_argument('--scenes', type=pathlib.Path, default=lanewise.COURSE, help='folder of the course scenes')
    parser.add_argument('--rounds', type=int, default=4, help=f'of {unbiased.ROUND} seeds')
    parser.add_argument('--share', type=float, default=1, help='of the samples under each seed')
    parser.add_argument('--threads', type=int, default=os.cpu_count())
    parser.add_argument('--quick', action='store_true', help='a small part; writes nothing')
    arguments = parser.parse_args()

    if not lanewise.PROGRAM.exists():
        raise SystemExit('build/lanewise is not there: tools/build')
    course = [arguments.scenes / f'{name}.dae' for name in ('CBspheres', 'CBspheres_lambertian')]
    paths = [OUTDOORS] + [path for path in course if path.exists()]
    depths, lenses = DEPTHS, (False, True)
    if arguments.quick:
        paths, depths, lenses = [OUTDOORS], [1, 5], (True,)
        arguments.rounds, arguments.share = min(arguments.rounds, 2), 0.25
    store = unbiased.Store()
    sky_file = store.folder / 'sky.pfm'
    lanewise.write_pfm(sky_file, sky())
    subjects = [Subject(path, sky_file, lens, arguments.threads) for path in paths for lens in lenses]
    work = [(subject, depth) for depth in depths for subject in subjects]
    unbiased.render_all(store, work, arguments.share, arguments.rounds)

    rows = []
    for subject in subjects:
        for depth in depths:
            found = unbiased.pictures(store, subject, depth, arguments.share, arguments.rounds)
            rows.append((subject.path.stem, subject.label, depth, welch.compare(*found, len(work))))
    command = ' '.join(['perf/peers/environment.py', *sys.argv[1:]])
    page, data = report.comparison_page(rows, command, unbiased.sample_sentence(arguments), 'camera',
                                        'Lanewise beside Mitsuba 3 under an environment map')
    if arguments.quick:
        print(page)
    else:
        report.print_and_write('environment', page, data)
    return 0 if all(all(c.verdicts.values()) for *_, c in rows) else 1


if __name__ == '__main__':
    sys.exit(main())
