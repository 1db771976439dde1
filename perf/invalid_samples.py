#!/usr/bin/python3
"""Counts samples that are NaN, infinite or negative over the course scenes, at depths 0-5 and 100; there must be none.

    perf/invalid_samples.py               # half an hour of two cores; writes perf/results/invalid_samples.md
    perf/invalid_samples.py -s 16         # half a minute; writes nothing

Smooth normals, the harder ones. Exits with 0 if every sample is valid.
"""
import argparse
import pathlib
import sys

import lanewise

DEPTHS = [0, 1, 2, 3, 4, 5, 100]  # the deepest are counted first: their paths hold the others'
SAMPLES = 1024


def statistics(scene, depth, samples, threads):
    flags = {'--view': 'fit', '--normals': 'smooth', '-s': samples, '-m': depth, '-t': threads}
    return lanewise.render(scene, *(word for flag in flags.items() for word in flag))[1]


def page(rows, samples, command):
    """rows: {scene: {depth: statistics}}."""
    everything = [s for stats in rows.values() for s in stats.values()]
    first = everything[0]
    total, invalid = (sum(s[key] for s in everything) for key in ('samples', 'invalid_samples'))
    lines = ['# Invalid samples', '',
             f'**{invalid} of {total:,} samples** are NaN, infinite or negative: {len(everything)} renders '
             f'of {len(rows)} course scenes, '
             f'{first["width"]} x {first["height"]} pixels, {samples} samples a pixel, smooth normals, {first["isa"]}, '
             f'Lanewise {first["version"]}.', '', f'    {command}', '',
             '| scene | ' + ' | '.join(f'-m {d}' for d in DEPTHS) + ' | rays, million | s |',
             '|---' * (len(DEPTHS) + 3) + '|']
    for scene, stats in rows.items():
        counts = ' | '.join(str(stats[d]['invalid_samples']) if d in stats else 'not run' for d in DEPTHS)
        rays = sum(s['rays']['total'] for s in stats.values()) / 1e6
        seconds = sum(s['seconds']['render'] for s in stats.values())
        lines.append(f'| {scene} | {counts} | {rays:,.0f} | {seconds:.0f} |')
    return '\n'.join(lines) + '\n', invalid


def main():
    parser = argparse.ArgumentParser(description='Counts invalid samples over the course scenes.')
    parser.add_argument('--scenes', type=pathlib.Path, default=lanewise.COURSE,
                        help='folder of the course scenes')
    parser.add_argument('-s', '--samples', type=int, default=SAMPLES, help='a pixel')
    parser.add_argument('-t', '--threads', type=int, default=0)
    arguments = parser.parse_args()
    scenes = sorted(arguments.scenes.glob('*.dae'))
    if not scenes:
        raise SystemExit(f'{arguments.scenes}: no scenes')
    rows = {scene.stem: {} for scene in scenes}
    for depth in reversed(DEPTHS):
        for scene in scenes:
            rows[scene.stem][depth] = statistics(scene, depth, arguments.samples, arguments.threads)
            print(scene.stem, depth, rows[scene.stem][depth]['invalid_samples'], flush=True)
            text, invalid = page(rows, arguments.samples, ' '.join(['perf/invalid_samples.py', *sys.argv[1:]]))
            if arguments.samples == SAMPLES:  # every time: a run that is cut short says how far it came
                (lanewise.RESULTS / 'invalid_samples.md').write_text(text)
    print(text)
    return 0 if invalid == 0 else 1


if __name__ == '__main__':
    sys.exit(main())
