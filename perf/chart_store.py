"""What `lanewise chart` has measured: references, points and pictures, kept."""
import dataclasses

import numpy as np

import lanewise
import picture_error
from kept import Kept, digest, half, write

FIRST_SEED = 1  # its pictures are kept, for the crops
REFERENCE_SEEDS = (1_000_001, 1_000_002)  # of no measured picture


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


class Store(Kept):
    def __init__(self, folder, deadline=float('inf')):
        super().__init__(folder, deadline)
        self.has_flip = picture_error.program_has_flip()

    def reference(self, subject, samples):
        """By Lanewise: the mean of two halves, whose difference tells its error."""
        identity = {**subject.identity(), 'program': lanewise.program_version()}
        count = max(1, samples // 2)
        halves = []
        for seed in REFERENCE_SEEDS:
            path = self._path(subject, 'reference', count, seed, identity)
            record = self.record(path, lambda: self._render_reference(subject, count, seed, path))
            halves.append((record['seconds'], np.load(path.with_suffix('.npy')).astype(float)))
        (first_seconds, a), (second_seconds, b) = halves
        mean = (a + b) / 2
        # The variance of a mean of two is a quarter of their squared difference.
        own = np.mean((a - b)**2 / 4 / (mean + picture_error.FLOOR)**2)
        return Reference(mean.astype(np.float32), 2 * count, float(own), first_seconds + second_seconds,
                         digest({**identity, 'samples': count}))

    def point(self, subject, reference, renderer, samples, seed):
        path = self._point_path(subject, reference, renderer, samples, seed)
        record = self.record(path, lambda: self._measure(subject, reference, renderer, samples, seed, path))
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
        if seed == FIRST_SEED:
            write(path.with_suffix('.npy'), half(picture))
        print(f'{subject.name}, seed {seed}: {renderer.name}, {samples} samples: {seconds:.3g} s, '
              f'MRSE {record["mrse"]:.3g}', flush=True)
        return record

    def _point_path(self, subject, reference, renderer, samples, seed):
        return self._path(subject, renderer.name, samples, seed, {
            **renderer.identity, 'reference': reference.key, 'threads': subject.threads, 'machine': lanewise.machine(),
            'flip': self.has_flip})

    def _path(self, subject, name, samples, seed, identity):
        return self.path(f'{subject.name} {name} s{samples} {seed}', identity)
