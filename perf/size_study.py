#!/usr/bin/python3
"""Cost against size: the same bumpy surface made of 10 thousand to 10 million triangles (builtin:dense).

    perf/size_study.py [--rounds 3]

Time of intersect per ray at bounces 1 and later on one thread, as `lanewise profile` has it; seconds of loading and planning
on all threads, and the peak of memory, from --stats. Ten million triangles are measured once.
"""
import json
import pathlib
import subprocess
import sys
import tempfile

import lanewise
import study
from study import plt

SIZES = [10**4, 10**5, 10**6, 10**7]
ONCE = 10**7  # and more
PICTURE = ['-r', 240, 180, '-s', 16, '-m', 5]
MEMORY_AIM = 4  # GiB, with ten million


def scene_of(triangles):
    return f'builtin:dense:{triangles}'


def bounce_rays(triangles):
    """ns per ray of intersect after the first scattering."""
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / 'profile.json'
        command = [lanewise.PROGRAM, 'profile', scene_of(triangles), *PICTURE, '-t', 1, '--no-scaling', '--repeat', 1 if triangles >= ONCE else 3,
                   '--json', out]
        subprocess.run([str(word) for word in command], check=True, stdout=subprocess.DEVNULL)
        stages = json.loads(out.read_text())['stages']
    bounces = [b for s in stages if s['name'] == 'intersect' for b in s['bounces'] if b['bounce'] > 0]
    return 1e9 * sum(b['seconds'] for b in bounces) / sum(b['paths'] for b in bounces)


def measure(triangles):
    stats = lanewise.render(scene_of(triangles), *PICTURE)[1]
    return {'ns_per_bounce_ray': bounce_rays(triangles), 'plan_seconds': stats['seconds']['plan'],
            'load_seconds': stats['seconds']['load'], 'peak_gib': stats['peak_rss_bytes'] / 2**30}


def draw(rows, command):
    figure, axes = plt.subplots(1, 3, figsize=(11, 4.2))
    for axis, key, label, power, guide in zip(
            axes, ['ns_per_bounce_ray', 'plan_seconds', 'peak_gib'],
            ['ns per bounce ray, one thread', 'seconds of planning', 'peak of memory (GiB)'],
            [1 / 6, 1, 1], ['~ N^(1/6)', '~ N', '~ N']):
        middle = [study.statistics.median(rows[n][key]) for n in SIZES]
        bars = [[m - min(rows[n][key]) for m, n in zip(middle, SIZES)], [max(rows[n][key]) - m for m, n in zip(middle, SIZES)]]
        axis.errorbar(SIZES, middle, yerr=bars, marker='o', capsize=3, color=study.COLOURS[0])
        axis.set_xscale('log')
        axis.set_yscale('log')
        study.slope_guide(axis, SIZES if power < 1 else SIZES[1:], middle[0 if power < 1 else 1] / 2, power, guide)
        for n, m in zip(SIZES, middle):
            axis.annotate(f'{m:.3g}', (n, m), textcoords='offset points', xytext=(0, 7), ha='center', fontsize=8)
        axis.set_xlabel('triangles')
        axis.set_ylabel(label)
        axis.margins(y=0.2)
    figure.suptitle('Cost against size', fontsize=11)
    figure.tight_layout(rect=(0, 0.03, 1, 1))
    study.save_chart(figure, 'size_study', command)


def main():
    rounds = study.parser_of(__doc__).parse_args().rounds
    rows = {n: {} for n in SIZES}
    for index in range(rounds):
        for n in SIZES:
            if n >= ONCE and index > 0:
                continue
            for key, value in measure(n).items():
                rows[n].setdefault(key, []).append(value)
            print(n, {key: round(values[-1], 3) for key, values in rows[n].items()}, flush=True)
    middle = {n: {key: study.statistics.median(values) for key, values in rows[n].items()} for n in SIZES}
    growth = study.ratios(rows[10**6]['ns_per_bounce_ray'], rows[10**4]['ns_per_bounce_ray'])
    body = [[f'{n:,}', f'{m["ns_per_bounce_ray"]:.0f}', f'{m["ns_per_bounce_ray"] / middle[SIZES[0]]["ns_per_bounce_ray"]:.2f}',
             f'{m["load_seconds"]:.2f}', f'{m["plan_seconds"]:.2f}', f'{m["peak_gib"]:.2f}',
             f'{(m["peak_gib"] - middle[SIZES[0]]["peak_gib"]) * 2**30 / n:.0f}' if n > SIZES[0] else '']
            for n, m in middle.items()]
    lines = ['Bounce rays (intersect, bounces 1 to 5) of one thread; loading and planning on all threads; 240 x 180 pixels, 16 '
             'samples. Medians; ten million once.', '']
    lines += study.table(['triangles', 'ns per bounce ray', 'x', 'load, s', 'plan, s', 'peak memory, GiB',
                          'bytes a triangle at the peak'], body)
    draw(rows, study.command_line())
    study.publish('size_study', 'Cost against size', lines,
                  [('time per bounce ray, 1,000,000 triangles over 10,000', f'{growth["median"]:.2f} x', '2 x at most'),
                   ('planning a million triangles', f'{middle[10**6]["plan_seconds"]:.2f} s', '2 s at most'),
                   ('ten million triangles: peak of memory', f'{middle[10**7]["peak_gib"]:.2f} GiB',
                    f'{MEMORY_AIM} GiB at most')], {'rows': rows})


if __name__ == '__main__':
    sys.exit(main())
