"""What `lanewise chart` renders, and with what: a subject, and renderers that take turns on it.

A renderer has a name, an identity (what its pictures and its speed hang on, for the cache), the sample counts of its
ladder, and render(subject, samples, seed), which gives the seconds of rendering alone and the picture.
"""
import hashlib
import json
import pathlib
import shlex
import subprocess
import sys
import tempfile

import lanewise
from command import Problem

sys.path.append(str(pathlib.Path(__file__).with_name('peers')))
import collada  # noqa: E402
import peer  # noqa: E402

# In the order in which the page has them: the fastest first. The samplers are the best that they have.
PEERS = {'mitsuba-llvm': ('mitsuba llvm_ad_rgb multijitter', 'Mitsuba 3 llvm'),
         'mitsuba-scalar': ('mitsuba scalar_rgb multijitter', 'Mitsuba 3 scalar'),
         'cycles': ('cycles', 'Cycles'),
         'luxcore': ('luxcore', 'LuxCore'),
         'luxcore-hybrid': ('luxcore hybrid', 'LuxCore hybrid')}

# Flags of `lanewise render` that the chart itself gives.
TAKEN = {'-s', '--spp', '--seed', '-r', '--resolution', '-f', '--output', '--stats', '-t', '--threads', '-m',
         '--max-depth', '-c', '--camera-file', '-p', '--crop', '--view', '--normals', '-q', '--quiet', '--rate'}


class Subject:
    """A scene under one camera, depth and size of the picture. Normals are flat: not all peers have others."""

    def __init__(self, scene, view, width, height, depth, threads):
        attempt(scene, [])  # before the peers' reader, which says less
        self.view, self.width, self.height, self.depth, self.threads = view, width, height, depth, threads
        self.flags = ['-r', width, height, '-m', depth, '-t', threads, '--normals', 'flat']
        builtin = scene.startswith('builtin:')
        self.path = scene if builtin else pathlib.Path(scene).resolve()
        self.name = scene.replace(':', '-') if builtin else self.path.stem
        self.content = scene if builtin else hashlib.sha256(self.path.read_bytes()).hexdigest()
        self.camera = None if builtin else self._common_camera()
        if not self.camera:
            self.flags += ['--view', view]

    def _common_camera(self):
        """One for all renderers, which at any resolution frames the same width; None if the peers' reader, which knows
        little of COLLADA, cannot read the file."""
        try:
            return collada.Scene(self.path).camera(self.view).framed(self.width, self.height)
        except (AttributeError, IndexError, KeyError, TypeError, ValueError):
            return None

    def identity(self):
        """Of the expected picture."""
        camera = self.camera and [*self.camera.eye, *self.camera.target, self.camera.tan_x]
        return {'scene': self.content, 'camera': camera or self.view, 'size': [self.width, self.height],
                'depth': self.depth}


class Configuration:
    """Lanewise under flags of its own."""
    is_peer = False

    def __init__(self, name, flags, samples):
        self.name, self.flags, self.samples = name, flags, samples
        self.version = ' '.join([lanewise.version(), *flags])
        program = hashlib.sha256(lanewise.PROGRAM.read_bytes()).hexdigest()
        self.identity = {'program': program, 'flags': flags}

    def render(self, subject, samples, seed):
        picture, stats = lanewise.render(subject.path, *subject.flags, '-s', samples, '--seed', seed, *self.flags,
                                         camera=subject.camera)
        return stats['seconds']['render'], picture


class PeerRenderer:
    """Another renderer, kept at work by peer.Peer, which loads a subject when it first renders it."""
    is_peer = True

    def __init__(self, name, at_work, samples):
        self.name, self.at_work, self.samples, self.version = name, at_work, samples, at_work.version
        self.identity = {'peer': at_work.name, 'version': at_work.version}
        self.subject, self.warm = None, set()

    def render(self, subject, samples, seed):
        try:
            return self._render(subject, samples, seed)
        except RuntimeError as error:
            raise Problem(f'{self.name}: {" ".join(str(error).split())}') from None

    def _render(self, subject, samples, seed):
        if subject is not self.subject:
            self.at_work.load(subject.path, subject.view, subject.width, subject.height, subject.threads)
            self.subject, self.warm = subject, set()
        # The first render builds trees; where kernels are compiled, the first with each number of samples does that.
        kind = samples if 'llvm' in self.at_work.name else 'any'
        if kind not in self.warm:
            self.warm.add(kind)
            self.at_work.render(subject.depth, samples if kind == samples else self.samples[0], 0)
        return self.at_work.render(subject.depth, samples, seed)


def attempt(scene, flags, what=''):
    """Renders next to nothing, so that what is wrong with a scene or with flags is known before the work begins."""
    with tempfile.TemporaryDirectory() as folder:
        command = [lanewise.PROGRAM, 'render', scene, '-q', '-f', f'{folder}/picture.pfm', '-r', 8, 6, '-s', 1, *flags]
        done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise Problem(what + done.stderr.strip().removeprefix('lanewise: '), done.returncode)


def configurations(args):
    """Those of --config and --configs; Lanewise without flags if there are none."""
    texts = [(f"--config '{text}'", *_split(text)) for text in args.config]
    if args.configs:
        texts += [(f'{args.configs}: {name}', name, flags) for name, flags in _read_file(args.configs).items()]
    found = []
    for where, name, text in texts or [('', 'Lanewise', '')]:
        try:
            flags = shlex.split(text)
        except ValueError as error:
            raise Problem(f'{where}: {error}', 2) from None
        for flag in flags:
            if flag in TAKEN:
                raise Problem(f'{where}: {flag} is for lanewise chart to choose', 2)
        if name in (r.name for r in found):
            raise Problem(f'{where}: there is a configuration of that name', 2)
        attempt(args.scenes[0], flags, f'{where}: ')
        found.append(Configuration(name, flags, args.samples))
    return found


def _split(text):
    name, colon, flags = text.partition(':')
    if not colon or not name.strip():
        raise Problem(f"--config '{text}': is not NAME: FLAGS", 2)
    return name.strip(), flags


def _read_file(path):
    try:
        configs = json.loads(path.read_text())
    except (OSError, ValueError) as error:
        raise Problem(f'{path}: {getattr(error, "strerror", None) or error}') from None
    if not isinstance(configs, dict) or not all(isinstance(flags, str) for flags in configs.values()):
        raise Problem(f'{path}: is not an object of names and flags, {{"NAME": "FLAGS", ...}}')
    return configs


def peers(args):
    """Those of --peers that are installed."""
    chosen = dict(PEERS[name] for name in (PEERS if args.peers == [] else args.peers or []))
    found = peer.start_peers(chosen)
    return [PeerRenderer(chosen[name], at_work, args.peer_samples) for name, at_work in found.items()]
