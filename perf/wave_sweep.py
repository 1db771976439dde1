#!/usr/bin/python3
"""Seconds of rendering against the wave's size: why the default of --wave is what it is.

    perf/wave_sweep.py [--scenes FOLDER] [--rounds 5] [--samples 16]

480 x 360 pixels, -m 5, flat normals, all threads; in every round each size renders each scene once. Each curve is relative to
the default's seconds in the same round, so that scenes of different cost stand in one chart.
"""
import sys

import lanewise
import study
from study import plt

SIZES = [256, 512, 1024, 2048, 4096, 8192, 16384, 32768]
DEFAULT = 4096


def lanes(stats):
    """The least share of living lanes of the stages that shade."""
    apart = ('generate', 'intersect', 'sort', 'accumulate')
    return min(stage['lanes_live'] for stage in stats['stages'] if stage['name'] not in apart)


def measure(scene, samples, rounds):
    least = {}

    def render(size):
        def once(_):
            stats = lanewise.render(scene, *study.view_flags(scene), '-m', 5, '-s', samples, '--wave', size)[1]
            least[size] = lanes(stats)
            return stats['seconds']['render']
        return once
    render(DEFAULT)(0)
    return study.in_turn({size: render(size) for size in SIZES}, rounds), least


def draw(relative, least, command):
    figure, (axis, below) = plt.subplots(2, 1, figsize=(8, 6.5), sharex=True, height_ratios=[2, 1])
    for k, scene in enumerate(relative):
        r = [relative[scene][size] for size in SIZES]
        axis.errorbar(SIZES, [v['median'] for v in r], yerr=study.error_bars(r), marker='o', markersize=4, capsize=3,
                      color=study.COLOURS[k], label=scene)
        below.plot(SIZES, [100 * least[scene][size] for size in SIZES], marker='o', markersize=4, color=study.COLOURS[k])
    for each in (axis, below):
        each.axvline(DEFAULT, color='black', linewidth=0.8, linestyle='--')
        each.set_xscale('log', base=2)
    below.axhline(95, color='grey', linewidth=0.8)
    below.set_ylabel('living lanes (%)')
    below.set_xticks(SIZES, [str(size) for size in SIZES])
    below.set_xlabel('--wave: paths in flight per thread (dashed: the default)')
    axis.set_ylabel(f'seconds / seconds at {DEFAULT}')
    axis.set_title('Seconds of rendering against the wave\'s size (median and range over rounds)', fontsize=11)
    axis.legend(fontsize=8)
    below.set_title('the stage with the fewest living lanes', fontsize=9)
    figure.tight_layout(rect=(0, 0.02, 1, 1))
    study.save_chart(figure, 'wave_sweep', command)


def main():
    parser = study.parser_of(__doc__)
    parser.add_argument('--samples', type=int, default=16, help='a pixel')
    arguments = parser.parse_args()
    seconds, least, relative = {}, {}, {}
    for scene in study.scenes_of(arguments, lanewise.SHIPPED[:1]):
        seconds[scene.stem], least[scene.stem] = measure(scene, arguments.samples, arguments.rounds)
        relative[scene.stem] = {size: study.ratios(values, seconds[scene.stem][DEFAULT])
                                for size, values in seconds[scene.stem].items()}
        print(scene.stem, {size: round(r['median'], 3) for size, r in relative[scene.stem].items()}, flush=True)
    body = [[scene] + [f'{r[size]["median"]:.3f}' + f' ({100 * least[scene][size]:.0f}%)' for size in SIZES]
            for scene, r in relative.items()]
    mean = {size: study.statistics.geometric_mean(r[size]['median'] for r in relative.values()) for size in SIZES}
    body.append(['geometric mean'] + [f'**{mean[size]:.3f}**' for size in SIZES])
    fastest = min(mean, key=mean.get)
    lines = [f'480 x 360 pixels, {arguments.samples} samples, -m 5: seconds relative to --wave {DEFAULT}, median over rounds; in '
             'parentheses the share of living lanes in the shading stage that has the fewest.', '']
    lines += study.table(['scene'] + [str(size) for size in SIZES], body)
    lines += ['', f'The fastest on average is {fastest} ({mean[fastest]:.3f}). A wave\'s two states take some '
              f'{2 * 30 * 4 * DEFAULT / 2**20:.1f} MiB at {DEFAULT} paths: larger ones leave the second-level cache, and cut the '
              'picture into fewer, larger tiles, at whose end threads wait for each other; smaller ones have bins of a few '
              'paths, whose last vector is mostly padding, and more calls for the same work.']
    draw(relative, least, study.command_line())
    study.publish('wave_sweep', 'The wave\'s size', lines,
                  [(f'seconds at the default --wave {DEFAULT}, over those of the best size ({fastest}), mean of scenes',
                    f'{mean[DEFAULT] / mean[fastest]:.3f}', '1'),
                   (f'living lanes in the emptiest shading stage at --wave {DEFAULT}, least of these scenes',
                    f'{100 * min(v[DEFAULT] for v in least.values()):.1f}%', '95%')],
                  {'samples': arguments.samples, 'seconds': seconds, 'lanes_live': least})


if __name__ == '__main__':
    sys.exit(main())
