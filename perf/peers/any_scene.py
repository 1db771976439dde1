#!/usr/bin/python3
"""Whether Lanewise and Mitsuba 3 (scalar_rgb) show the same picture of scenes of your own, but for noise.

    perf/peers/setup                                        # once: Mitsuba into build-peers/venv
    perf/peers/any_scene.py room.dae [box.glb ...] [-m 5] [-s 1024]

Any file that Lanewise reads, seen from its camera, 120 x 90 pixels, as `lanewise convert` writes it. Sixteen pictures
of each renderer; the tests are those of welch.py. Mitsuba finds light by way of mirror and glass spheres by chance alone, so
Lanewise renders with --connect off --light-paths off --reuse off. Exits with 0 if every verdict is good or if Mitsuba is not
installed, which it says.
"""
import argparse
import os
import pathlib
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
VENV = ROOT / 'build-peers' / 'venv'
PYTHON = VENV / 'bin' / 'python'
if pathlib.Path(sys.prefix).resolve() != VENV.resolve():
    if not PYTHON.exists():
        print('any_scene.py: skipped, Mitsuba is not installed; perf/peers/setup installs it')
        sys.exit(0)
    os.execv(PYTHON, [PYTHON, __file__, *sys.argv[1:]])

import numpy as np  # noqa: E402

sys.path.append(str(ROOT / 'perf'))
import lanewise  # noqa: E402
import render_mitsuba  # noqa: E402
import welch  # noqa: E402

WIDTH, HEIGHT, PICTURES = 120, 90, 16


def of_lanewise(scene, depth, samples):
    flags = '--connect', 'off', '--light-paths', 'off', '--reuse', 'off', '-r', WIDTH, HEIGHT, '-m', depth, '-s', samples
    return np.stack([lanewise.render(scene, *flags, '--seed', seed)[0] for seed in range(PICTURES)])


def of_mitsuba(scene, depth, samples):
    import mitsuba
    mitsuba.set_variant(render_mitsuba.VARIANT)
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / 'scene.xml'
        lanewise.convert(scene, file, '-r', WIDTH, HEIGHT, '-m', depth)
        loaded = mitsuba.load_file(str(file), sampler='independent', samples=samples)
    return np.stack([np.array(mitsuba.render(loaded, spp=samples, seed=render_mitsuba.SEED_STRIDE * seed))
                     for seed in range(PICTURES)])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('scenes', metavar='SCENE', nargs='+', type=pathlib.Path)
    parser.add_argument('-m', dest='depth', type=int, default=5)
    parser.add_argument('-s', dest='samples', type=int, default=1024, help='a pixel of each picture (default: 1024)')
    options = parser.parse_args()
    good = True
    for scene in options.scenes:
        result = welch.compare(of_lanewise(scene, options.depth, options.samples),
                               of_mitsuba(scene, options.depth, options.samples), pictures=len(options.scenes))
        good &= all(result.verdicts.values())
        print(f'{scene}: ' + ', '.join(f'{test} {"good" if fine else "BAD"}' for test, fine in result.verdicts.items()))
        print(f'  pixels that pass {100 * min(result.pixels):.2f}%, p below {welch.LOW_P} {100 * result.low_p:.2f}% (at most '
              f'{100 * result.low_p_limit:.2f}%), worst block p = {result.worst_block:.3f}, means differ by '
              + ', '.join(f'{100 * d:+.4f}% +- {100 * e:.4f}%' for d, e in zip(result.difference, result.error)))
    return 0 if good else 1


if __name__ == '__main__':
    sys.exit(main())
