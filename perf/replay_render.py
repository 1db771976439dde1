"""What `lanewise replay` renders, each once: kept by command line, scene and program."""
import dataclasses
import hashlib
import time

import numpy as np

import lanewise
from kept import Kept, half, write


@dataclasses.dataclass
class Rendered:
    shot: object
    picture: np.ndarray  # linear, (height, width, 3)
    rate: bytes  # a PNG; empty: none
    seconds: float  # of rendering alone
    rays: int
    mrse: dict  # estimated: value, low, high; or None
    samples_per_pixel: float


class Studio(Kept):
    def __init__(self, folder):
        super().__init__(folder)
        self.program = _hash(lanewise.PROGRAM)
        self.scenes, self.progress = {}, None

    def render(self, scene, *flags):
        """The picture and what is kept of the run's statistics, with the error's estimate."""
        path = self._path(scene, flags)
        record = self.record(path, lambda: self._render(scene, flags, path))
        return np.load(path.with_suffix('.npy')).astype(np.float32), record

    def shoot(self, shot):
        flags = shot.flags + (['--rate', self._path(shot.scene, shot.flags + ['--rate']).with_suffix('.png')]
                              if shot.rate else [])
        picture, record = self.render(shot.scene, *flags)
        return Rendered(shot, picture, flags[-1].read_bytes() if shot.rate else b'', record['seconds'], record['rays'],
                        record['mrse'], record['samples_per_pixel'])

    def has(self, scene, *flags):
        return self._path(scene, flags).exists()

    def _render(self, scene, flags, path):
        picture, stats = lanewise.render(scene, *flags, estimate=True)
        write(path.with_suffix('.npy'), half(picture))
        return {'seconds': stats['seconds']['render'], 'rays': stats['rays']['total'],
                'mrse': stats.get('estimated_mrse'), 'samples_per_pixel': stats['samples_per_pixel'],
                'paths_by_length': stats['paths_by_length']}

    def _path(self, scene, flags):
        if scene not in self.scenes:
            self.scenes[scene] = _hash(scene)
        words = [word.name if hasattr(word, 'name') else str(word) for word in flags]
        return self.path(scene.stem, {'scene': self.scenes[scene], 'flags': words, 'program': self.program,
                                      'machine': lanewise.machine()})


class Progress:
    """Lines with the time left, reckoned from what this run's renders took."""

    def __init__(self, total):
        self.total, self.done, self.rendered, self.start = total, 0, 0, time.monotonic()

    def step(self, what, seconds, is_new):
        self.done += 1
        self.rendered += is_new
        if is_new:
            left = (time.monotonic() - self.start) / self.rendered * (self.total - self.done)
            print(f'{self.done} of {self.total}: {what}: {seconds:.3g} s; about {_duration(left)} left', flush=True)


def _duration(seconds):
    return f'{seconds:.0f} s' if seconds < 90 else f'{seconds / 60:.0f} min'


def _hash(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()
