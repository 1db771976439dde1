#!/usr/bin/python3
"""The error that renders estimate of themselves, against the one measured; and when renders with --time end.

    perf/error_estimate.py [--scenes FILE... | FOLDER] [--samples 16 64 256] [--seeds 2] [--times 2 5 10]

Every picture is compared with a reference of many samples, whose own estimated error is taken off what is measured. Writes
perf/results/error_estimate.{json,md,svg}; exits with 1 if a prediction is off by 20% or more of the measured MRSE. Needs
tools/build and tools/setup charts; takes some 15 minutes on two cores.
"""
import argparse
import itertools
import json
import pathlib
import sys

import matplotlib.pyplot as plt
import numpy as np

import lanewise
import picture_error
import study

SIZE = 320, 240


def predictions(scene, arguments):
    def render(*flags):
        return study.render_whole(scene, SIZE, *flags, estimate=True)
    truth, stats = render('-s', arguments.reference, '--seed', 10**6)
    if not truth.any():
        return []  # no light, no error
    own = stats['estimated_mrse']['value']
    rows = []
    for samples in arguments.samples:
        for seed, allocation in itertools.product(range(1, arguments.seeds + 1), ('even', 'noise')):
            picture, stats = render('-s', samples, '--seed', seed, '--allocation', allocation)
            measured, predicted = picture_error.mrse(picture, truth) - own, stats['estimated_mrse']
            rows.append({'scene': scene.stem, 'samples': samples, 'allocation': allocation, 'seed': seed,
                         'measured': measured, **predicted, 'reference': own})
            print(json.dumps(rows[-1]), flush=True)
    return rows


def endings(scene, arguments):
    rows = []
    for seconds in arguments.times:
        _, stats = lanewise.render(scene, *study.view_flags(scene), '--time', f'{seconds}s', estimate=True)
        spent = sum(stats['seconds'][part] for part in ('load', 'plan', 'render'))
        rows.append({'scene': scene.stem, 'budget': seconds, 'seconds': spent, 'samples': stats['samples_per_pixel']})
        print(json.dumps(rows[-1]), flush=True)
    return rows


def page(rows, ends, command):
    inside = sum(r['low'] <= r['measured'] <= r['high'] for r in rows)
    lines = ['# The error that a render estimates of itself', '', f'    {command}', '',
             f'{lanewise.machine()}; Lanewise {lanewise.version()}.', '', '![](error_estimate.svg)', '',
             f'Predicted and measured MRSE; {inside} of {len(rows)} measured ones lie in their 95% interval. Pictures of 320 x 240.',
             '']
    lines += study.table(['scene', 'samples', 'allocation', 'seed', 'measured', 'predicted', '95%', 'predicted / measured'],
                         [[r['scene'], str(r['samples']), r['allocation'], str(r['seed']), f"{r['measured']:.4g}", f"{r['value']:.4g}",
                           f"{r['low']:.4g} to {r['high']:.4g}", f"{r['value'] / r['measured']:.2f}"] for r in rows])
    lines += ['', 'When `--time` ends: seconds from the program\'s start to the end of rendering, 480 x 360.', '']
    lines += study.table(['scene', 'budget', 'seconds', 'off by', 'samples per pixel'],
                         [[e['scene'], f"{e['budget']:g} s", f"{e['seconds']:.3f}",
                           f"{100 * (e['seconds'] / e['budget'] - 1):+.1f}%", f"{e['samples']:.1f}"] for e in ends])
    return '\n'.join(lines) + '\n'


def draw(rows, command):
    figure, axis = plt.subplots(figsize=(7, 6))
    looks = [(colour, marker) for marker in 'o^' for colour in study.COLOURS]
    for (colour, marker), scene in zip(looks, dict.fromkeys(r['scene'] for r in rows)):
        mine = [r for r in rows if r['scene'] == scene]
        value = np.array([r['value'] for r in mine])
        bars = [value - [r['low'] for r in mine], [r['high'] for r in mine] - value]
        axis.errorbar([r['measured'] for r in mine], value, bars, color=colour, marker=marker, markersize=5, capsize=3,
                      markerfacecolor=colour if marker == 'o' else 'white',
                      linestyle='none', label=scene)
    ends = np.array([min(r['measured'] for r in rows), max(r['measured'] for r in rows)])
    axis.plot(ends, ends, color='black', linewidth=0.8)
    axis.fill_between(ends, ends * 0.8, ends * 1.2, color='grey', alpha=0.2, linewidth=0, label='within 20%')
    axis.set_xscale('log')
    axis.set_yscale('log')
    axis.set_xlabel('measured MRSE')
    axis.set_ylabel('predicted MRSE, with its 95% interval')
    axis.legend(fontsize=8)
    figure.tight_layout(rect=(0, 0.03, 1, 1))
    study.save_chart(figure, 'error_estimate', command)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split('\n', maxsplit=1)[0])
    parser.add_argument('--scenes', nargs='+', type=pathlib.Path, help='scene files, or folders of them')
    parser.add_argument('--samples', nargs='+', type=int, default=[16, 64, 256])
    parser.add_argument('--seeds', type=int, default=2)
    parser.add_argument('--reference', type=int, default=2048, help='samples of the reference')
    parser.add_argument('--times', nargs='*', type=float, default=[2, 5, 10], help='budgets in seconds')
    arguments = parser.parse_args()
    scenes = study.all_scenes_of(arguments.scenes)
    rows = [row for scene in scenes for row in predictions(scene, arguments)]
    lit = {r['scene'] for r in rows}
    ends = [row for scene in scenes if scene.stem in lit for row in endings(scene, arguments)]
    command = study.command_line()
    lanewise.RESULTS.mkdir(exist_ok=True)
    (lanewise.RESULTS / 'error_estimate.json').write_text(
        json.dumps({'command': command, 'lanewise': lanewise.version(), 'machine': lanewise.machine(), 'rows': rows,
                    'endings': ends}, indent=1) + '\n')
    (lanewise.RESULTS / 'error_estimate.md').write_text(page(rows, ends, command))
    draw(rows, command)
    worst = max(abs(r['value'] / r['measured'] - 1) for r in rows)
    print(f'predictions are off by {100 * worst:.0f}% at most')
    return 0 if worst < 0.2 else 1


if __name__ == '__main__':
    sys.exit(main())
