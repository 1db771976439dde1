"""What `lanewise chart` has measured, kept in a cache folder: one small file for each render, written when it is done,
so that a run which is cut short goes on where it was. A file's name ends in a hash of all that its content hangs on."""
import dataclasses
import hashlib
import json
import os
import re
import time

import numpy as np

import lanewise
import picture_error

FIRST_SEED = 1  # its pictures are kept, for the crops
REFERENCE_SEEDS = (1_000_001, 1_000_002)  # of no measured picture


class OutOfTime(Exception):
    """The next render would begin after the deadline."""


@dataclasses.dataclass
class Reference:
    picture: np.ndarray
    samples: int  # a pixel, in both halves
    mrse: float  # its own, which adds to that of all that is measured against it
    seconds: float
    key: str


@dataclasses.dataclass
class Point:
    """One render. The reference's own error is taken off its MRSE; flip is None where the program cannot tell it."""
    renderer: str
    samples: int
    seed: int
    seconds: float
    mrse: float
    flip: float | None


class Store:
    def __init__(self, folder, deadline=float('inf')):
        """deadline: a value of time.monotonic()."""
        self.folder, self.deadline = folder, deadline
        self.rendered, self.cut_short = 0, False  # in this run
        self.has_flip = picture_error.program_has_flip()
        folder.mkdir(parents=True, exist_ok=True)

    def reference(self, subject, samples):
        """By Lanewise: the mean of two halves, whose difference tells its error."""
        identity = {**subject.identity(), 'program': lanewise.program_version()}
        half = max(1, samples // 2)
        halves = []
        for seed in REFERENCE_SEEDS:
            path = self._path(subject, 'reference', half, seed, identity)
            record = self._kept(path, lambda: self._render_reference(subject, half, seed, path))
            halves.append((record['seconds'], np.load(path.with_suffix('.npy')).astype(float)))
        (first_seconds, a), (second_seconds, b) = halves
        mean = (a + b) / 2
        # The variance of a mean of two is a quarter of their squared difference.
        own = np.mean((a - b)**2 / 4 / (mean + picture_error.FLOOR)**2)
        return Reference(mean.astype(np.float32), 2 * half, float(own), first_seconds + second_seconds,
                         _digest({**identity, 'samples': half}))

    def point(self, subject, reference, renderer, samples, seed):
        path = self._point_path(subject, reference, renderer, samples, seed)
        record = self._kept(path, lambda: self._measure(subject, reference, renderer, samples, seed, path))
        return Point(renderer.name, samples, seed, record['seconds'], record['mrse'] - reference.mrse, record['flip'])

    def picture(self, subject, reference, renderer, samples):
        """The first seed's, and its point."""
        point = self.point(subject, reference, renderer, samples, FIRST_SEED)
        path = self._point_path(subject, reference, renderer, samples, FIRST_SEED)
        return np.load(path.with_suffix('.npy')).astype(np.float32), point

    def _render_reference(self, subject, samples, seed, path):
        print(f'{subject.name}: half of the reference, {samples} samples a pixel', flush=True)
        picture, stats = lanewise.render(subject.path, *subject.flags, '-s', samples, '--seed', seed,
                                         camera=subject.camera)
        write(path.with_suffix('.npy'), picture)
        return {'seconds': stats['seconds']['render']}

    def _measure(self, subject, reference, renderer, samples, seed, path):
        seconds, picture = renderer.render(subject, samples, seed)
        record = {'seconds': seconds, 'mrse': picture_error.mrse(picture, reference.picture),
                  'flip': picture_error.flip(picture, reference.picture) if self.has_flip else None}
        if seed == FIRST_SEED:  # half precision is finer than a screen
            write(path.with_suffix('.npy'), np.minimum(picture, 6e4).astype(np.float16))
        print(f'{subject.name}, seed {seed}: {renderer.name}, {samples} samples: {seconds:.3g} s, '
              f'MRSE {record["mrse"]:.3g}', flush=True)
        return record

    def _point_path(self, subject, reference, renderer, samples, seed):
        return self._path(subject, renderer.name, samples, seed, {
            **renderer.identity, 'reference': reference.key, 'threads': subject.threads, 'machine': lanewise.machine(),
            'flip': self.has_flip})

    def _path(self, subject, name, samples, seed, identity):
        slug = re.sub(r'[^a-z0-9]+', '-', f'{subject.name} {name}'.lower()).strip('-')
        return self.folder / f'{slug}-s{samples}-{seed}-{_digest(identity)}.json'

    def _kept(self, path, make):
        if path.exists():
            return json.loads(path.read_text())
        if time.monotonic() > self.deadline:
            self.cut_short = True
            raise OutOfTime
        record = make()
        self.rendered += 1
        write(path, json.dumps(record))
        return record


def write(path, content):
    """Text, or an array as .npy; whole or not at all."""
    part = path.with_name(f'{path.name}.{os.getpid()}.part')
    with open(part, 'wb') as file:
        if isinstance(content, str):
            file.write(content.encode())
        else:
            np.save(file, content)
    part.rename(path)


def _digest(identity):
    return hashlib.sha256(json.dumps(identity, sort_keys=True).encode()).hexdigest()[:12]
