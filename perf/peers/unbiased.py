#!/usr/bin/python3
"""Compares Lanewise with Mitsuba 3 (scalar_rgb), picture by picture: are they the same but for noise?

    perf/peers/setup                      # once: Mitsuba into build-peers/venv
    perf/peers/unbiased.py --quick        # a minute: two scenes, two depths, few samples, nothing written
    perf/peers/unbiased.py                # an hour of two cores; writes perf/results/mitsuba.md and .json
    perf/peers/unbiased.py --validate     # after it: what the tests accept and find, on the same pictures

Scenes x depths x normals, 120 x 90 pixels, in rounds of four seeds; every round is kept in build-peers/renders and
taken from there when the script runs again, as long as the scene and, for Lanewise, the program are the same. All
pictures get the rounds asked for, whatever they show, so that no test chooses when it ends. The tests are those of
welch.py. Those of pixels ask for estimators that are alike, so for them Lanewise leaves out what Mitsuba has nothing like:
light paths, connections by way of spheres, paths used again. (Where Mitsuba finds a caustic by chance, most pixels that have not
met it yet take a mean that is too low for well known.) For blocks and means it renders as it does by default, five times the
samples under other seeds. Where no vertex is shared by faces of different directions, smooth normals are flat ones: the
script checks that each renderer gives the same picture for either, and compares once.

Exits with 0 if every verdict is good or if Mitsuba is not installed, which it says.
"""
import argparse
import hashlib
import os
import pathlib
import sys
import time
import zlib

ROOT = pathlib.Path(__file__).resolve().parents[2]
VENV = ROOT / 'build-peers' / 'venv'
PYTHON = VENV / 'bin' / 'python'
if pathlib.Path(sys.prefix).resolve() != VENV.resolve():
    if not PYTHON.exists():
        print('unbiased.py: skipped, Mitsuba is not installed; perf/peers/setup installs it')
        sys.exit(0)
    os.execv(PYTHON, [PYTHON, __file__, *sys.argv[1:]])

import numpy as np  # noqa: E402

sys.path.append(str(ROOT / 'perf'))
import collada  # noqa: E402
import lanewise  # noqa: E402
import render_mitsuba  # noqa: E402
import report  # noqa: E402
import welch  # noqa: E402

WIDTH, HEIGHT = 120, 90
DEPTHS = [0, 1, 2, 3, 4, 5, 100]
ROUND = 4  # seeds
MORE = 5  # times the samples, for Lanewise's means and blocks
ALIKE = ['--light-paths', 'off', '--connect', 'off', '--reuse', 'off']


def samples_of(subject, share):
    """Under each seed, a square for Mitsuba's strata. Scenes that are diffuse throughout are the calm ones."""
    calm = all(s.material['kind'] in ('diffuse', 'emission') for s in subject.scene.shapes)
    side = 4 if calm else 6
    return max(2, round(side * share**0.5)) ** 2


class Subject:
    """A scene with one kind of normals."""

    def __init__(self, path, normals, threads):
        self.path, self.normals, self.threads = path, normals, threads
        self.label = self.key = normals  # for the table, and for the store to tell pictures of a scene apart
        self.scene = collada.Scene(path)
        self.camera = self.scene.camera('file' if path in lanewise.SHIPPED else 'fit')
        self.flags = []  # what both are to render beside the scene, as of Lanewise
        self.loaded = None

    def lanewise(self, depth, samples, seed, *flags, normals=None):
        picture, stats = lanewise.render(
            self.path, *self.flags, *flags, '-r', WIDTH, HEIGHT, '-s', samples, '-m', depth, '--seed', seed,
            '--normals', normals or self.normals, '-t', self.threads, camera=self.camera)
        if stats['invalid_samples']:
            raise SystemExit(f'{self.path}: {stats["invalid_samples"]} invalid samples')
        return picture

    def mitsuba(self, depth, samples, seed, normals=None):
        if normals or not self.loaded:
            loaded = render_mitsuba.MitsubaScene(self.scene, self.camera, normals or self.normals, WIDTH, HEIGHT,
                                                 self.threads, flags=self.flags)
            loaded.check_shapes(self.scene)
            if normals:
                return loaded.render(depth, samples, seed)
            self.loaded = loaded
        return self.loaded.render(depth, samples, seed)

    def check_flat_is_smooth(self):
        """Bits of Lanewise's, sums of Mitsuba's: its barycentric normals are rounded."""
        if (self.lanewise(5, 4, 1, normals='flat') != self.lanewise(5, 4, 1, normals='smooth')).any():
            raise SystemExit(f'{self.path}: Lanewise renders flat faces otherwise with smooth normals')
        flat, smooth = (self.mitsuba(2, 4, 1, normals).mean() for normals in ('flat', 'smooth'))
        if abs(flat - smooth) > 1e-4 * flat:
            raise SystemExit(f'{self.path}: Mitsuba renders flat faces otherwise with smooth normals')


def sample_sentence(arguments):
    share = f' times {arguments.share:g}' * (arguments.share != 1)
    return (f'{WIDTH} x {HEIGHT} pixels, {arguments.rounds * ROUND} seeds of 36 samples a pixel (16 in scenes that are '
            f'diffuse throughout){share}, for pixels and shares of Lanewise with {" ".join(ALIKE)}, which is the '
            f'estimator of Mitsuba; for blocks and means of Lanewise as it is by default, {MORE} times the samples. None of '
            'its samples was NaN, infinite or negative.')


class Store:
    """Rounds of renders on disk."""

    def __init__(self):
        self.folder = ROOT / 'build-peers' / 'renders'
        self.folder.mkdir(parents=True, exist_ok=True)
        self.versions = {'mitsuba': render_mitsuba.mitsuba_version(), 'alike': digest(lanewise.PROGRAM),
                         'more': digest(lanewise.PROGRAM)}

    def path(self, kind, subject, depth, samples, index):
        return self.folder / '-'.join([kind, self.versions[kind], subject.path.stem, digest(subject.path),
                                       subject.key, f'm{depth}', f's{samples}', f'{index}.npy'])

    def get(self, kind, subject, depth, samples, index):
        """Round `index`: (ROUND, height, width, 3)."""
        path = self.path(kind, subject, depth, samples, index)
        if not path.exists():
            render = subject.mitsuba if kind == 'mitsuba' else subject.lanewise
            flags = ALIKE if kind == 'alike' else []
            # No two pictures of the table share random numbers.
            first = zlib.crc32('-'.join([kind, subject.path.stem, subject.key, str(depth)]).encode()) >> 4
            seeds = range(first + index * ROUND, first + (index + 1) * ROUND)
            pictures = np.array([render(depth, samples, seed, *flags) for seed in seeds], np.float32)
            part = path.with_suffix('.part')
            with open(part, 'wb') as file:
                np.save(file, pictures)
            part.rename(path)
        return np.load(path)

    def rounds(self, kind, subject, depth, samples, count):
        return np.concatenate([self.get(kind, subject, depth, samples, i) for i in range(count)])


def digest(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()[:8]


def pictures(store, subject, depth, share, rounds):
    """Lanewise's that are alike, Mitsuba's with as many samples, and Lanewise's by default, with more."""
    samples = samples_of(subject, share)
    ours, theirs = (store.rounds(kind, subject, depth, samples, rounds) for kind in ('alike', 'mitsuba'))
    return ours, theirs, store.rounds('more', subject, depth, MORE * samples, rounds)


def validation(store, work, share, rounds):
    """Groups of comparisons for report.validation_page."""
    sets = {(s.path.stem, s.normals, depth): pictures(store, s, depth, share, rounds) for s, depth in work}
    half = rounds * ROUND // 2

    def each(change, keys=None):
        return [welch.compare(*change(key), len(sets)) for key in keys or sets]

    def scaled(error, window=np.s_[:]):
        def change(key):
            ours, theirs, more = (x.copy() for x in sets[key])
            ours[:, window] *= 1 + error
            more[:, window] *= 1 + error
            return ours, theirs, more
        return change

    def deeper(key):
        scene, normals, depth = key
        ours, _, more = sets[scene, normals, depth + 1]
        return ours, sets[key][1], more

    def flatter(key):
        ours, _, more = sets[key[0], 'flat', key[2]]
        return ours, sets[key][1], more

    yield 'Lanewise, half against half', each(lambda k: (sets[k][0][:half], sets[k][0][half:], None))
    yield 'Mitsuba, half against half', each(lambda k: (sets[k][1][:half], sets[k][1][half:], None))
    yield 'Lanewise against Mitsuba', each(lambda k: sets[k])
    for error in (0.003, 0.01, 0.03, 0.1):
        yield f'all pixels {100 * error:g}% too bright', each(scaled(error))
    yield 'the middle tenth of the rows 5% too bright', each(scaled(0.05, np.s_[40:50]))
    yield 'one bounce more than asked for', each(deeper, [k for k in sets if k[2] < 5])
    smooth = [k for k in sets if k[1] == 'smooth' and k[2] > 0]
    yield 'flat normals where smooth ones are asked for', each(flatter, smooth)


def render_all(store, work, share, rounds):
    start, done, total = time.time(), 0, rounds * len(work)
    for index in range(rounds):
        for subject, depth in work:
            samples = samples_of(subject, share)
            store.get('mitsuba', subject, depth, samples, index)
            store.get('alike', subject, depth, samples, index)
            store.get('more', subject, depth, MORE * samples, index)
            done += 1
            print(f'{done}/{total}  round {index + 1}  {subject.path.stem} {subject.label} -m {depth}  '
                  f'{time.time() - start:.0f} s', flush=True)


def subjects(paths, threads):
    """Flat and smooth, or flat alone where that is the same."""
    for path in paths:
        flat = Subject(path, 'flat', threads)
        if collada.has_smooth_faces(flat.scene):
            yield from (flat, Subject(path, 'smooth', threads))
        else:
            flat.check_flat_is_smooth()
            flat.label = 'both'
            yield flat


def main():
    parser = argparse.ArgumentParser(description='Compares Lanewise with Mitsuba 3 by tests of equal means.')
    parser.add_argument('--scenes', type=pathlib.Path, default=lanewise.COURSE,
                        help='folder of the course scenes')
    parser.add_argument('--rounds', type=int, default=4, help=f'of {ROUND} seeds')
    parser.add_argument('--share', type=float, default=1, help='of the samples under each seed')
    parser.add_argument('--threads', type=int, default=os.cpu_count())
    parser.add_argument('--shipped', action='store_true', help='the scenes of scenes/ too')
    parser.add_argument('--quick', action='store_true', help='a small part; writes nothing')
    parser.add_argument('--validate', action='store_true', help='the tests themselves, on pictures rendered before')
    arguments = parser.parse_args()

    if not lanewise.PROGRAM.exists():
        raise SystemExit('build/lanewise is not there: tools/build')
    shipped = lanewise.SHIPPED
    course = sorted(arguments.scenes.glob('*.dae'))
    depths = DEPTHS
    if arguments.quick:
        course, depths = [p for p in course if p.stem == 'CBbunny_microfacet_cu'], [1, 5]
        arguments.shipped = True
        arguments.rounds, arguments.share = min(arguments.rounds, 2), 0.25
    all_subjects = list(subjects(course + shipped * arguments.shipped, arguments.threads))
    work = [(s, depth) for depth in depths for s in all_subjects]
    store = Store()
    render_all(store, work, arguments.share, arguments.rounds)

    command = ' '.join(['perf/peers/unbiased.py', *sys.argv[1:]])
    if arguments.quick and arguments.validate:
        parser.error('--validate needs all depths: not with --quick')
    if arguments.validate:
        groups = validation(store, work, arguments.share, arguments.rounds)
        report.print_and_write('mitsuba_validation', report.validation_page(groups, command))
        return 0
    rows = []
    for subject in all_subjects:
        for depth in depths:
            found = pictures(store, subject, depth, arguments.share, arguments.rounds)
            rows.append((subject.path.stem, subject.label, depth, welch.compare(*found, len(work))))
    page, data = report.comparison_page(rows, command, sample_sentence(arguments))
    if arguments.quick:
        print(page)
    else:
        report.print_and_write('mitsuba', page, data)
    return 0 if all(all(c.verdicts.values()) for *_, c in rows) else 1


if __name__ == '__main__':
    sys.exit(main())
