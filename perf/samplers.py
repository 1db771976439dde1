#!/usr/bin/python3
"""How many samples each sampler needs: error against samples per pixel, of direct light and of whole pictures.

    perf/samplers.py [--scenes FILE... | FOLDER] [--samples 4 16 64 256] [--seeds 6]

Both samplers render the same pictures with all else equal; every picture is compared with a reference of many samples, whose
own estimated error is taken off. The seeds are for the most samples; with fewer, whose error a few fireflies may be, there are more,
up to MOST_SEEDS. Writes perf/results/samplers.{json,md,svg}; exits with 1 if Sobol numbers need more than half the samples of
independent ones for direct light, or are anywhere more than 5% worse, by more than two standard errors. Needs tools/build and
tools/setup charts; takes some 40 minutes on two cores.
"""
import argparse
import json
import pathlib
import sys

import matplotlib.pyplot as plt
import numpy as np

import lanewise
import picture_error
import study

SIZE = 160, 120
SAMPLERS = {'sobol': 'Sobol, Owen-scrambled', 'random': 'independent'}
MOST_SEEDS = 32
PARTS = {'direct light': ['-m', 1], 'whole picture': ['-m', 5]}


def curves(scene, part, arguments):
    """MRSE by sampler and sample count, mean of the seeds; or nothing, of a scene without light."""
    def render(*flags, estimate=False):
        return study.render_whole(scene, SIZE, *PARTS[part], *flags, estimate=estimate)
    truth, stats = render('-s', arguments.reference, '--seed', 10**6, estimate=True)
    if not truth.any():
        return None
    own = stats['estimated_mrse']['value']
    found = {'scene': scene.stem, 'part': part, 'reference': own, 'samples': arguments.samples}
    for sampler in SAMPLERS:
        errors = [[picture_error.mrse(render('-s', samples, '--sampler', sampler, '--seed', seed)[0], truth) - own
                   for seed in range(1, seeds_of(samples, arguments) + 1)] for samples in arguments.samples]
        found[sampler] = [float(np.mean(same)) for same in errors]
        found[sampler + ' error'] = [float(np.std(same, ddof=1) / np.sqrt(len(same))) for same in errors]
    found |= {'share': share_of_samples(found), 'ratio': ratios(found),
              'slopes': {sampler: slope(found['samples'], found[sampler]) for sampler in SAMPLERS}}
    print(json.dumps(found), flush=True)
    return found


def seeds_of(samples, arguments):
    return max(arguments.seeds, min(MOST_SEEDS, arguments.seeds * arguments.samples[-1] // samples))


def ratios(found):
    """Error of Sobol over that of independent numbers at each number of samples, and its standard error."""
    columns = (np.array(found[key]) for key in ('sobol', 'sobol error', 'random', 'random error'))
    return [(float(s / r), float(np.hypot(s_error / s, r_error / r) * s / r)) for s, s_error, r, r_error in zip(*columns)]


def worst(found):
    """The largest of the ratios, less two standard errors of each."""
    return max(ratio - 2 * error for ratio, error in found['ratio'])


def share_of_samples(found):
    """Of those that independent samples took for their least error, how many Sobol needs for it; along straight lines
    between the points, on log axes."""
    logs = np.log(found['samples']), np.log(found['sobol']), np.log(found['random'])
    return float(np.exp(np.interp(-logs[2][-1], -logs[1], logs[0]) - logs[0][-1]))


def slope(samples, error):
    return float(np.polyfit(np.log(samples), np.log(error), 1)[0])


def draw(found, command):
    scenes = list(dict.fromkeys(f['scene'] for f in found))
    figure, axes = plt.subplots(len(scenes), len(PARTS), figsize=(8, 2.3 * len(scenes)), sharex=True, squeeze=False)
    for f in found:
        axis = axes[scenes.index(f['scene'])][list(PARTS).index(f['part'])]
        for sampler, colour, marker in zip(SAMPLERS, study.COLOURS, 'os'):
            axis.errorbar(f['samples'], f[sampler], yerr=f[sampler + ' error'], color=colour, marker=marker, markersize=4,
                          capsize=2, label=f'{SAMPLERS[sampler]}: slope −{-f["slopes"][sampler]:.2f}')
        axis.set_xscale('log')
        axis.set_yscale('log')
        ends = np.array([f['samples'][0], f['samples'][-1]])
        axis.plot(ends, f['random'][0] * 1.3 * ends[0] / ends, color='grey', linewidth=0.8, linestyle='--', label='slope −1')
        axis.set_title(f'{f["scene"]}, {f["part"]}', fontsize=9, loc='left')
        axis.set_ylim(top=6 * axis.get_ylim()[1])  # room for the legend
        axis.legend(fontsize=7, loc='upper right', frameon=False)
        axis.set_xticks(f['samples'], [str(s) for s in f['samples']])
        axis.minorticks_off()
    for axis in axes[-1]:
        axis.set_xlabel('samples per pixel')
    for row in axes:
        row[0].set_ylabel('MRSE')
    figure.tight_layout(rect=(0, 0.01, 1, 1))
    study.save_chart(figure, 'samplers', command)


def page(found, command):
    lines = ['# Samplers: error against samples', '', f'    {command}', '',
             f'{lanewise.machine()}; Lanewise {lanewise.version()}.', '', '![](samplers.svg)', '',
             f'MRSE of Owen-scrambled Sobol numbers over that of independent ones, at equal samples, ± one standard error; the share of the '
             f'{found[0]["samples"][-1]} samples of the independent ones that Sobol needs for their error; slopes fitted '
             'to all points. Direct light is -m 1, the whole picture -m 5.', '']
    for part in PARTS:
        mine = [f for f in found if f['part'] == part]
        lines += [f'## {part.capitalize()}', '']
        lines += study.table(['scene', *(f'at {s}' for s in mine[0]['samples']), 'samples needed', 'slope, Sobol',
                              'slope, independent'],
                             [[f['scene'], *(f'{ratio:.2f} ± {error:.2f}' for ratio, error in f['ratio']),
                               f"{100 * f['share']:.0f}%", *(f"{f['slopes'][s]:.2f}" for s in SAMPLERS)] for f in mine]) + ['']
    return '\n'.join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split('\n', maxsplit=1)[0])
    parser.add_argument('--scenes', nargs='+', type=pathlib.Path, help='scene files, or folders of them')
    parser.add_argument('--samples', nargs='+', type=int, default=[4, 16, 64, 256])
    parser.add_argument('--seeds', type=int, default=6, help='with the most samples; at least 2')
    parser.add_argument('--reference', type=int, default=8192, help='samples of the reference')
    arguments = parser.parse_args()
    every = [curves(scene, part, arguments) for scene in study.all_scenes_of(arguments.scenes) for part in PARTS]
    found = [f for f in every if f]
    command = study.command_line()
    lanewise.RESULTS.mkdir(exist_ok=True)
    (lanewise.RESULTS / 'samplers.json').write_text(
        json.dumps({'command': command, 'lanewise': lanewise.version(), 'machine': lanewise.machine(), 'curves': found},
                   indent=1) + '\n')
    (lanewise.RESULTS / 'samplers.md').write_text(page(found, command))
    draw(found, command)
    short = [f for f in found if worst(f) > 1.05 or (f['part'] == 'direct light' and f['share'] > 0.5)]
    for f in short:
        print(f'{f["scene"]}, {f["part"]}: {f["share"]:.2f} of the samples, at least {worst(f):.2f} of the error somewhere')
    return 1 if short else 0


if __name__ == '__main__':
    sys.exit(main())
