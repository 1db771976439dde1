#!/usr/bin/python3
"""Compares Lanewise with Mitsuba 3 (scalar_rgb) under an environment map, through a pinhole and through a thin lens.

    perf/peers/setup                         # once: Mitsuba into build-peers/venv
    perf/peers/environment.py --quick        # a minute: one scene, few samples, nothing written
    perf/peers/environment.py                # half an hour of two cores; writes perf/results/environment.md and .json

As unbiased.py, whose rounds and tests these are. The map, 64 x 32 texels, is made here: a gradient, a sun of nine
texels, dark ground. The scenes are a shipped one and the boxes of the course with spheres, open towards the camera. The
box with mirror and glass is rendered with connections and without: the test of shares asks for estimators that are
alike, and Mitsuba finds light by way of a sphere by chance, so that many of its pixels, which have met no caustic yet,
take a mean that is too low for well known.

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
import render_mitsuba  # noqa: E402
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


class Store(unbiased.Store):
    """Mitsuba's pictures are the same with connections and without; ours without lie apart."""

    def path(self, kind, subject, depth, samples, index):
        path = super().path(kind, subject, depth, samples, index)
        return path if kind == 'mitsuba' or subject.connect else path.with_name(f'unconnected-{path.name}')


class Subject(unbiased.Subject):
    """A scene under the sky, flat."""

    def __init__(self, path, sky_file, lens, connect, threads):
        super().__init__(path, 'flat', threads)
        if path == OUTDOORS:
            self.camera = self.scene.camera('file')
        self.connect = connect
        self.label = ('thin lens' if lens else 'pinhole') + ', --connect off' * (not connect)
        # As the store tells renders apart.
        self.normals = f'{"lens" if lens else "pinhole"}-{unbiased.digest(sky_file)}'
        places = [s.positions.mean(0) if hasattr(s, 'positions') else s.center for s in self.scene.shapes]
        distance = float(np.linalg.norm(np.mean(places, 0) - self.camera.eye))
        self.flags = ['-e', sky_file] + (['-b', LENS * distance, '-d', distance] if lens else [])

    def lanewise(self, depth, samples, seed, normals=None):
        picture, stats = lanewise.render(
            self.path, *self.flags, '--light-paths', 'off', '--reuse', 'off', '--connect', 'on' if self.connect else 'off',
            '-r', str(unbiased.WIDTH), str(unbiased.HEIGHT), '-s', str(samples), '-m', str(depth), '--seed', str(seed), '--normals', 'flat', '-t',
            str(self.threads), camera=self.camera)
        if stats['invalid_samples']:
            raise SystemExit(f'{self.path}: {stats["invalid_samples"]} invalid samples')
        return picture

    def mitsuba(self, depth, samples, seed, normals=None):
        if not self.loaded:
            self.loaded = render_mitsuba.MitsubaScene(
                self.scene, self.camera, 'flat', unbiased.WIDTH, unbiased.HEIGHT, self.threads,
                flags=self.flags)
            self.loaded.check_shapes(self.scene)
        return self.loaded.render(depth, samples, seed)


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
    store = Store()
    sky_file = store.folder / 'sky.pfm'
    lanewise.write_pfm(sky_file, sky())
    subjects = [Subject(path, sky_file, lens, connect, arguments.threads) for path in paths for lens in lenses
                for connect in ((True, False) if path.stem == 'CBspheres' else (True,))]
    work = [(subject, depth) for depth in depths for subject in subjects]
    unbiased.render_all(store, work, arguments.share, arguments.rounds)

    rows = []
    for subject in subjects:
        for depth in depths:
            found = unbiased.pictures(store, subject, depth, arguments.share, arguments.rounds)
            rows.append((subject.path.stem, subject.label, depth, welch.compare(*found, len(work))))
    command = ' '.join(['perf/peers/environment.py', *sys.argv[1:]])
    samples = unbiased.sample_sentence(arguments) + (
        ' Where Lanewise connects vertices to the light by way of spheres (CBspheres from -m 2 on) its estimator is '
        'another than Mitsuba\'s, and the test of shares does not apply; the rows with --connect off are for it.')
    page, data = report.comparison_page(rows, command, samples, 'camera',
                                        'Lanewise beside Mitsuba 3 under an environment map')
    if arguments.quick:
        print(page)
    else:
        report.print_and_write('environment', page, data)
    return 0 if all(all(c.verdicts.values()) for *_, c in rows) else 1


if __name__ == '__main__':
    sys.exit(main())
