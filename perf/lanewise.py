"""Lanewise from its command line, for the scripts that measure, compare and count."""
import json
import os
import pathlib
import subprocess
import tempfile

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[1]
BUILD = ROOT / 'build'
PROGRAM = pathlib.Path(os.environ.get('LANEWISE_BINARY', BUILD / 'lanewise'))
RESULTS = ROOT / 'perf' / 'results'
# Not furnace.dae, whose answer is in its first comment.
SHIPPED = [ROOT / 'scenes' / f'{name}.dae' for name in ('cornell_spheres', 'cornell_metal')]
COURSE = ROOT.parent / 'shared' / 'scenes'  # the course's scenes, which do not come with the project


def render(scene, *flags, camera=None, estimate=False):
    """The picture (height, width, 3), row 0 at the top, and the run's statistics. camera: a collada.Camera. estimate: the
    error too, which takes samples of its own."""
    with tempfile.TemporaryDirectory() as folder:
        picture, stats = (pathlib.Path(folder) / name for name in ('picture.pfm', 'stats.json'))
        if not estimate:
            flags = '--no-estimate', *flags
        _run('render', scene, '-q', '-f', picture, '--stats', stats, *flags, camera=camera)
        return read_pfm(picture), json.loads(stats.read_text())


def convert(scene, output, *flags, camera=None):
    """Writes the scene for another renderer."""
    _run('convert', scene, '-q', '-f', output, *flags, camera=camera)


def _run(*command, camera):
    if not PROGRAM.exists():
        raise SystemExit(f'{PROGRAM} is not there: tools/build')
    with tempfile.TemporaryDirectory() as folder:
        if camera:
            view = pathlib.Path(folder) / 'camera.json'
            view.write_text(json.dumps({
                'eye': camera.eye.tolist(), 'target': camera.target.tolist(),
                'xfov': float(2 * np.degrees(np.arctan(camera.tan_x))), 'aspect': camera.tan_x / camera.tan_y}))
            command = *command, '-c', view
        command = [str(word) for word in (PROGRAM, *command)]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise SystemExit(f'{" ".join(command)}: {done.stderr}')


def read_pfm(path):
    _, size, _, pixels = path.read_bytes().split(b'\n', 3)
    width, height = map(int, size.split())
    return np.frombuffer(pixels, '<f4').reshape(height, width, 3)[::-1].copy()


def write_pfm(path, picture):
    height, width, _ = picture.shape
    path.write_bytes(f'PF\n{width} {height}\n-1\n'.encode() + picture[::-1].astype('<f4').tobytes())


def program_version():
    said = subprocess.run([PROGRAM, '--version'], capture_output=True, text=True, check=True).stdout
    return said.splitlines()[0].removeprefix('lanewise ')


def version():
    """Of the program, with the commit of the sources around it, where they and git are there."""
    git = ['git', '-C', ROOT, 'rev-parse', '--short', 'HEAD']
    try:
        commit = subprocess.run(git, capture_output=True, text=True, check=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return program_version()
    return f'{program_version()} ({commit})'


def processor():
    fields = _first_processor()
    return f"{fields['model name']} (family {fields['cpu family']}, model {fields['model']})"


def machine():
    """What a speed may be compared with: family and cores, no more."""
    fields = _first_processor()
    maker = {'AuthenticAMD': 'AMD', 'GenuineIntel': 'Intel'}.get(fields['vendor_id'], fields['vendor_id'])
    return f"{maker} family {fields['cpu family']} model {fields['model']}, {os.cpu_count()} cores"


def _first_processor():
    with open('/proc/cpuinfo', encoding='utf-8') as info:
        fields = dict(line.split(':', 1) for line in info.read().split('\n\n')[0].splitlines() if ':' in line)
    return {key.strip(): value.strip() for key, value in fields.items()}
