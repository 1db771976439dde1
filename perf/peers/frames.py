#!/usr/bin/python3
"""Seconds of rendering beside Mitsuba 3 and Cycles: the same scenes, cameras, depths and numbers of samples.

    perf/peers/setup --all                # once: Mitsuba and Cycles into build-peers, LLVM for Mitsuba
    perf/peers/frames.py [--scenes FOLDER] [--rounds 5] [--full]

480 x 360 pixels, -m 5, flat normals, 2 threads. In every round each renderer renders once, under a seed of the round; the
renders before the first round, in which Mitsuba compiles its kernels, do not count. Seconds are of rendering alone: without
loading, building of trees and writing of files. Before any time is told, the pictures' means are compared: 4 standard errors
of the difference, and 0.2% for Cycles' tessellated spheres, are what they may be apart. At 64 samples a pixel only the fastest
peer runs unless --full asks for all. Renderers that are not installed are left out, and that is said.
"""
import pathlib
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1]))
import numpy as np  # noqa: E402

import collada  # noqa: E402
import lanewise  # noqa: E402
import peer  # noqa: E402
import study  # noqa: E402
from study import plt  # noqa: E402

WIDTH, HEIGHT, DEPTH, THREADS = 480, 360, 5, 2
# As the peers: perf/chart.py is for what ours is worth.
SAME_ESTIMATOR = ['--sampler', 'random', '--connect', 'off', '--light-paths', 'off', '--reuse', 'off']
FASTEST = 'mitsuba llvm_ad_rgb'
LABELS = {FASTEST: 'Mitsuba 3 llvm_ad_rgb', 'mitsuba scalar_rgb': 'Mitsuba 3 scalar_rgb', 'cycles': 'Cycles'}
AIMS = {'CBspheres': 10, 'CBbunny_microfacet_cu': 3, 'CBdragon_microfacet_au': 3}


class Loaded:
    """A peer under this study's settings."""

    def __init__(self, renderer):
        self.renderer, self.version, self.close = renderer, renderer.version, renderer.close

    def load(self, scene, view):
        self.renderer.load(scene, view, WIDTH, HEIGHT, THREADS)

    def render(self, samples, seed):
        return self.renderer.render(DEPTH, samples, seed)


class Lanewise:
    def load(self, scene, view):
        self.scene, self.camera = scene, collada.Scene(scene).camera(view).framed(WIDTH, HEIGHT)

    def render(self, samples, seed):
        picture, stats = lanewise.render(self.scene, '-r', WIDTH, HEIGHT, '-s', samples, '-m', DEPTH, '-t', THREADS,
                                         '--normals', 'flat', '--seed', seed, *SAME_ESTIMATOR, camera=self.camera)
        return stats['seconds']['render'], picture


def mean_and_error(pictures):
    """Of the mean over pixels, R G B; the pixels' variances over the renders tell its error."""
    x = np.array(pictures, float)
    return x.mean((0, 1, 2)), np.sqrt(x.var(0, ddof=1).sum((0, 1)) / len(x)) / (x.shape[1] * x.shape[2])


def check_means(scene, samples, pictures):
    """The largest difference from Lanewise of each peer, relative and in standard errors."""
    found = {}
    ours, our_error = mean_and_error(pictures['lanewise'])
    for name in pictures:
        if name == 'lanewise':
            continue
        theirs, error = mean_and_error(pictures[name])
        difference, error = np.abs(ours - theirs), np.hypot(error, our_error)
        tolerance = 4 * error + (0.002 * theirs if name == 'cycles' else 0)
        if not (difference <= tolerance).all():  # so too where they are NaN
            raise SystemExit(f'{scene.stem}, {samples} samples: the means of Lanewise {ours} and {name} {theirs} differ by '
                             f'more than noise ({error}): no time is told')
        worst = np.argmax(difference / theirs)
        found[name] = {'relative': float(difference[worst] / theirs[worst]), 'error': float(error[worst] / theirs[worst])}
    return found


def measure(renderers, scene, samples, rounds):
    pictures = {name: [] for name in renderers}

    def render(name):
        def once(index):
            seconds, picture = renderers[name].render(samples, 1 + index)
            pictures[name].append(picture)
            print(f'{scene.stem} {samples} spp, round {index + 1}: {name} {seconds:.3f} s', flush=True)
            return seconds
        return once
    for renderer in renderers.values():
        renderer.render(samples, 0)
    seconds = study.in_turn({name: render(name) for name in renderers}, rounds)
    differences = check_means(scene, samples, pictures)
    return {'scene': scene.stem, 'samples': samples, 'seconds': seconds, 'differences': differences,
            'times_faster': {name: study.ratios(seconds[name], seconds['lanewise']) for name in differences}}


def seconds_text(values):
    return f'{np.median(values):.3g}'


def section(rows, peers, versions):
    lines = [f'{WIDTH} x {HEIGHT} pixels, -m {DEPTH}, flat normals, {THREADS} threads; '
             + ', '.join(f'{LABELS[n]} ({v})' for n, v in versions.items()) + '. Seconds of rendering alone, medians of '
             f'{len(rows[0]["seconds"]["lanewise"])} renders in turn; in parentheses how many times faster Lanewise is, '
             'median of the rounds and their range. Peers\' first renders do not count. The pictures\' means were found '
             'equal first; the last column is their largest difference.', '']
    body = []
    for row in rows:
        cells = [row['scene'], str(row['samples']), seconds_text(row['seconds']['lanewise'])]
        for name in peers:
            if name not in row['times_faster']:
                cells.append('')
                continue
            r = row['times_faster'][name]
            cells.append(f'{seconds_text(row["seconds"][name])} (**{r["median"]:.1f} x**, {r["least"]:.1f} to '
                         f'{r["largest"]:.1f})')
        worst = max(row['differences'].values(), key=lambda d: d['relative'])
        body.append(cells + [f'{100 * worst["relative"]:.2f}% ± {100 * worst["error"]:.2f}%'])
    return lines + study.table(['scene', 'samples', 'Lanewise'] + [LABELS[n] for n in peers] + ['means'], body)


def headlines(rows):
    return [(f'{row["scene"]}, {row["samples"]} samples: times faster than {LABELS[FASTEST]}',
             f'{row["times_faster"][FASTEST]["median"]:.1f}', f'{AIMS[row["scene"]]}')
            for row in rows if row['scene'] in AIMS and FASTEST in row['times_faster']]


def draw(rows, peers, command):
    figure, axis = plt.subplots(figsize=(8, 2 + 0.42 * len(rows)))
    names = list(peers)
    for k, name in enumerate(names):
        mine = [(y, row['times_faster'][name]) for y, row in enumerate(rows) if name in row['times_faster']]
        offset = 0.22 * (k - (len(names) - 1) / 2)
        x = [r['median'] for _, r in mine]
        axis.errorbar(x, [y + offset for y, _ in mine], xerr=study.error_bars([r for _, r in mine]), fmt='o', capsize=3,
                      markersize=5, color=study.COLOURS[k], label=LABELS[name])
    for y, row in enumerate(rows):
        if row['scene'] in AIMS:
            axis.plot([AIMS[row['scene']]] * 2, [y - 0.4, y + 0.4], color='black', linewidth=1.2,
                      label='aimed at, against llvm_ad_rgb' if y == 0 else None)
    axis.set_xscale('log')
    ticks = [1, 2, 3, 5, 10, 20, 50, 100]
    top = max(r['largest'] for row in rows for r in row['times_faster'].values())
    axis.set_xlim(1, 1.25 * top)
    axis.set_xticks([t for t in ticks if t < 1.25 * top], [f'{t} x' for t in ticks if t < 1.25 * top])
    axis.minorticks_off()
    axis.set_yticks(range(len(rows)), [f'{row["scene"]}, {row["samples"]} spp' for row in rows])
    axis.set_ylim(len(rows) - 0.5, -0.5)
    axis.set_xlabel('seconds of the peer / seconds of Lanewise (median and range over rounds)')
    axis.set_title('How many times faster Lanewise renders the same samples', fontsize=11)
    figure.legend(fontsize=8, loc='lower center', ncol=4, bbox_to_anchor=(0.5, 0.04))
    figure.tight_layout(rect=(0, 0.13, 1, 1))
    study.save_chart(figure, 'frames', command)


def main():
    parser = study.parser_of(__doc__)
    parser.add_argument('--samples', nargs='+', type=int, default=[16, 64], help='a pixel')
    parser.add_argument('--full', action='store_true', help='all peers at all numbers of samples')
    arguments = parser.parse_args()
    if arguments.rounds < 2:
        parser.error('--rounds: two at least, for the pictures\' noise is known by their spread')
    peers = {name: Loaded(each) for name, each in peer.start_peers(LABELS).items()}
    if not peers:
        return 0
    rows = []
    try:
        for scene in study.scenes_of(arguments):
            view = 'file' if scene in lanewise.SHIPPED else 'fit'
            all_renderers = {'lanewise': Lanewise(), **peers}
            for renderer in all_renderers.values():
                renderer.load(scene, view)
            for samples in arguments.samples:
                few = arguments.full or samples == min(arguments.samples)
                chosen = {n: r for n, r in all_renderers.items() if few or n in ('lanewise', FASTEST)}
                if len(chosen) > 1:
                    rows.append(measure(chosen, scene, samples, arguments.rounds))
    finally:
        for each in peers.values():
            each.close()
    versions = {name: each.version for name, each in peers.items()}
    draw(rows, peers, study.command_line())
    study.publish('frames', 'Frames against other renderers', section(rows, peers, versions), headlines(rows),
                  {'versions': versions, 'rows': rows})
    return 0


if __name__ == '__main__':
    sys.exit(main())
