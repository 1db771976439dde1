"""Other renderers at work, each in a process of its own and in its own virtual environment: see peer_worker.py."""
import json
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1]))
import lanewise  # noqa: E402

LLVM = ['/usr/lib/x86_64-linux-gnu/libLLVM.so.19.1', '/usr/lib/llvm-19/lib/libLLVM.so.1']
# In build-peers, by the first word of a peer's name.
VENVS = {'mitsuba': 'venv', 'cycles': 'venv-cycles', 'luxcore': 'venv-luxcore'}


class Peer:
    """name: as peer_worker.py takes it."""

    def __init__(self, name, python):
        environment = dict(os.environ)
        llvm = [path for path in LLVM if os.path.exists(path)]
        if llvm:
            environment.setdefault('DRJIT_LIBLLVM_PATH', llvm[0])
        self.name, self.log = name, tempfile.TemporaryFile('w+')
        worker = pathlib.Path(__file__).with_name('peer_worker.py')
        self.process = subprocess.Popen([python, worker, name], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                        stderr=self.log, text=True, env=environment)
        self.version = self._answer()['version']

    def load(self, scene, view, width, height, threads):
        self._ask(scene=str(scene), view=view, width=width, height=height, threads=threads)

    def render(self, depth, samples, seed):
        """Seconds of rendering alone, and the picture."""
        with tempfile.TemporaryDirectory() as folder:
            picture = pathlib.Path(folder) / 'picture.npy'
            seconds = self._ask(depth=depth, samples=samples, seed=seed, picture=str(picture))['seconds']
            return seconds, np.load(picture)

    def close(self):
        self.process.stdin.close()
        self.process.wait()

    def _ask(self, **request):
        self.process.stdin.write(json.dumps(request) + '\n')
        self.process.stdin.flush()
        return self._answer()

    def _answer(self):
        line = self.process.stdout.readline()
        if not line:
            self.log.seek(0)
            raise RuntimeError(f'{self.name} ended:\n' + ''.join(self.log.readlines()[-15:]))
        return json.loads(line)


def start_peers(labels):
    """labels: {name: what users call it}. {name: Peer} of those that are installed; says which are not."""
    peers = {}
    for name, label in labels.items():
        python = lanewise.ROOT / 'build-peers' / VENVS[name.split()[0]] / 'bin' / 'python'
        if not python.exists():
            checkout = '' if (lanewise.ROOT / 'perf/peers/setup').exists() else ' in a checkout of Lanewise, which runs it'
            print(f'{label}: left out, it is not installed; perf/peers/setup --all installs it{checkout}')
            continue
        try:
            peers[name] = Peer(name, python)
        except RuntimeError as error:
            print(f'{label}: left out, {error}')
    return peers
