#!/usr/bin/python3
"""Speed-up over threads, scene by scene.

    perf/thread_scaling.py [--scenes FOLDER] [--rounds 5] [--samples 16]

480 x 360 pixels, -m 5, flat normals; in every round each number of threads renders each scene once. A speed-up is that of one
round: seconds of rendering with one thread / with N. Where other programs run beside, it tells of them.
"""
import os
import sys

import lanewise
import study
from study import plt

AIM = 0.95  # of each thread


def thread_counts():
    cores = os.cpu_count()
    return sorted({1, cores, *(2**k for k in range(1, 9) if 2**k <= cores)})


def measure(scene, samples, rounds):
    def render(threads):
        return lambda index: lanewise.render(scene, *study.view_flags(scene), '-m', 5, '-s', samples, '-t', threads)[1][
            'seconds']['render']
    render(1)(0)
    return study.in_turn({threads: render(threads) for threads in thread_counts()}, rounds)


def draw(found, counts, command):
    figure, axis = plt.subplots(figsize=(8, 1.6 + 0.32 * len(found)))
    for k, threads in enumerate(counts):
        efficiency = [{key: v / threads for key, v in r[threads].items()} for r in found.values()]
        axis.errorbar([e['median'] for e in efficiency], range(len(found)), xerr=study.error_bars(efficiency), fmt='o',
                      capsize=3, markersize=5, color=study.COLOURS[k % len(study.COLOURS)], label=f'{threads} threads')
    axis.axvline(1, color='black', linewidth=0.8)
    axis.axvline(AIM, color='black', linewidth=1, linestyle='--', label='aimed at')
    axis.set_yticks(range(len(found)), list(found))
    axis.invert_yaxis()
    axis.set_xlabel('efficiency: speed-up / threads (median and range over rounds)')
    axis.set_title('What each thread adds', fontsize=11)
    figure.legend(fontsize=8, loc='lower center', ncol=6, bbox_to_anchor=(0.5, 0.03))
    figure.tight_layout(rect=(0, 0.09, 1, 1))
    study.save_chart(figure, 'thread_scaling', command)


def main():
    parser = study.parser_of(__doc__)
    parser.add_argument('--samples', type=int, default=16, help='a pixel')
    arguments = parser.parse_args()
    counts = thread_counts()[1:]
    if not counts:
        raise SystemExit('thread_scaling.py: one core has nothing to scale over')
    scenes = study.scenes_of(arguments)
    if arguments.scenes is None and lanewise.COURSE.exists():
        scenes = sorted(lanewise.COURSE.glob('*.dae')) + lanewise.SHIPPED
    seconds, found = {}, {}
    for scene in scenes:
        seconds[scene.stem] = measure(scene, arguments.samples, arguments.rounds)
        found[scene.stem] = {n: study.ratios(seconds[scene.stem][1], seconds[scene.stem][n]) for n in counts}
        print(scene.stem, {n: round(r['median'], 3) for n, r in found[scene.stem].items()}, flush=True)
    body = [[scene, f'{study.statistics.median(seconds[scene][1]):.3f}']
            + [f'{r["median"]:.2f} ({r["least"]:.2f} to {r["largest"]:.2f}), {100 * r["median"] / n:.0f}%'
               for n, r in by_count.items()] for scene, by_count in found.items()]
    lines = [f'480 x 360 pixels, {arguments.samples} samples, -m 5, flat normals: seconds of rendering with one thread, and the '
             'speed-up with more: median over rounds, range, efficiency.', '']
    lines += study.table(['scene', '1 thread, s'] + [f'{n} threads' for n in counts], body)
    least = min(r[counts[0]]['median'] for r in found.values())
    draw(found, counts, study.command_line())
    study.publish('thread_scaling', 'Threads', lines,
                  [(f'speed-up from 1 to {counts[0]} threads, the least of {len(found)} scenes', f'{least:.2f}',
                    f'{AIM * counts[0]:.2g}')], {'samples': arguments.samples, 'seconds': seconds, 'speed_up': found})


if __name__ == '__main__':
    sys.exit(main())
