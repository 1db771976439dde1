#!/usr/bin/python3
"""Bias of the two stopping rules, -a and --noise: many independent renders of small pictures against a reference.

    perf/adaptive_bias.py [--renders 64] [--scenes FILE...]

For each scene, rule and target it renders with K seeds and compares the mean of all renders with a reference of a fixed
number of samples. The bias counts where it is not small beside the standard error of one render, that is the noise which
the rule leaves in the mean of the picture. Writes perf/results/adaptive_bias.{json,md,svg}; exits with 1 if the bias of
--noise is a third of that error or more. Needs tools/build and tools/setup charts; takes some 20 minutes on two cores.
"""
import argparse
import json
import math
import sys
from pathlib import Path

import matplotlib

matplotlib.use('svg')
import matplotlib.pyplot as plt
import numpy as np

import lanewise
from lanewise import RESULTS

TARGETS = [0.4, 0.2, 0.1, 0.05]  # standard error of a pixel, relative; -a takes 1.96 times that as its tolerance
RULES = {
    '-a 16': lambda x: ['-a', '16', f'{1.96 * x:.4g}', '-s', '65536'],
    '-a 64': lambda x: ['-a', '64', f'{1.96 * x:.4g}', '-s', '65536'],
    '--noise': lambda x: ['--noise', f'{x:g}'],
}


def render(scene, flags, seed):
    """Mean luminance of the picture, and samples per pixel."""
    picture, stats = lanewise.render(scene, '--view', 'fit', '-r', '96', '72', '--seed', str(seed), *flags)
    y = picture.astype(float) @ [0.2126, 0.7152, 0.0722]
    return y.mean(), stats['samples'] / y.size


def measure(scene, renders, reference_spp):
    parts = [render(scene, ['-s', str(reference_spp // 8)], 10**6 + k)[0] for k in range(8)]
    reference, reference_se = np.mean(parts), np.std(parts, ddof=1) / math.sqrt(len(parts))
    rows = []
    for rule, flags in RULES.items():
        for target in TARGETS:
            runs = [render(scene, flags(target), seed) for seed in range(1, renders + 1)]
            means = np.array([mean for mean, _ in runs])
            se = means.std(ddof=1)
            rows.append({
                'scene': scene.stem, 'rule': rule, 'target': target,
                'samples_per_pixel': float(np.mean([samples for _, samples in runs])),
                'bias': float(means.mean() / reference - 1),
                'bias_error': float(math.hypot(se / math.sqrt(renders), reference_se) / reference),
                'standard_error': float(se / reference),
            })
            print(json.dumps(rows[-1]), flush=True)
    return rows


def table(rows, command):
    lines = [f'Made by `{command}`. All but samples in % of the mean luminance of the picture; "error of one render" is its '
             'standard error.', '',
             '| scene | rule | pixel error aimed at | samples per pixel | bias | error of one render | bias / error |',
             '|---|---|---|---|---|---|---|']
    for r in rows:
        lines.append(f"| {r['scene']} | `{r['rule']}` | {100 * r['target']:g} | {r['samples_per_pixel']:.0f} | "
                     f"{100 * r['bias']:+.3f} ± {100 * r['bias_error']:.3f} | {100 * r['standard_error']:.3f} | "
                     f"{r['bias'] / r['standard_error']:+.2f} |")
    return '\n'.join(lines) + '\n'


def draw(rows, command, path):
    scenes = list(dict.fromkeys(r['scene'] for r in rows))
    figure, axes = plt.subplots(1, len(scenes), figsize=(4 * len(scenes), 4), sharey=True, squeeze=False)
    colours = {'-a 16': '#d95f02', '-a 64': '#e6ab02', '--noise': '#1b6ca8'}
    for axis, scene in zip(axes[0], scenes):
        axis.axhline(0, color='black', linewidth=0.8)
        for rule, colour in colours.items():
            mine = [r for r in rows if r['scene'] == scene and r['rule'] == rule]
            x = [100 * r['target'] for r in mine]
            axis.errorbar(x, [100 * r['bias'] for r in mine], [100 * r['bias_error'] for r in mine], color=colour,
                          marker='o', markersize=4, capsize=3, label=rule)
            if rule == '--noise':
                third = np.array([100 * r['standard_error'] / 3 for r in mine])
                axis.fill_between(x, -third, third, color=colour, alpha=0.2, linewidth=0,
                                  label='a third of one render\'s error')
        axis.set_xscale('log')
        axis.set_xticks([100 * t for t in TARGETS], [f'{100 * t:g}' for t in TARGETS])
        axis.minorticks_off()
        axis.set_yscale('symlog', linthresh=0.1, linscale=0.8)
        axis.set_yticks([-10, -1, -0.1, 0, 0.1], ['-10', '-1', '-0.1', '0', '0.1'])
        axis.set_title(scene, fontsize=10)
        axis.set_xlabel('standard error aimed at (% of a pixel)')
    axes[0][0].set_ylabel('bias of the mean luminance (%)')
    figure.legend(*axes[0][0].get_legend_handles_labels(), fontsize=8, loc='lower center', ncol=4, bbox_to_anchor=(0.5, 0.03))
    figure.suptitle('Pixels that stop on their own samples end too dark (symmetric log axis)', fontsize=11)
    figure.text(0.995, 0.005, command, ha='right', fontsize=7, color='grey')
    figure.tight_layout(rect=(0, 0.1, 1, 1))
    figure.savefig(path)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split('\n')[0])
    parser.add_argument('--renders', type=int, default=64, help='independent renders for each point')
    parser.add_argument('--reference-spp', type=int, default=131072)
    parser.add_argument('--scenes', nargs='+', type=Path,
                        default=lanewise.SHIPPED)
    parser.add_argument('--redraw', action='store_true', help='draw from perf/results/adaptive_bias.json')
    args = parser.parse_args()
    command = ' '.join(['perf/adaptive_bias.py', *sys.argv[1:]])
    data = RESULTS / 'adaptive_bias.json'
    if args.redraw:
        saved = json.loads(data.read_text())
        rows, command = saved['rows'], saved['command']
    else:
        rows = [row for scene in args.scenes for row in measure(scene, args.renders, args.reference_spp)]
    RESULTS.mkdir(exist_ok=True)
    data.write_text(json.dumps({'command': command, 'rows': rows}, indent=1) + '\n')
    (RESULTS / 'adaptive_bias.md').write_text(table(rows, command))
    draw(rows, command, RESULTS / 'adaptive_bias.svg')
    worst = max(abs(r['bias'] / r['standard_error']) for r in rows if r['rule'] == '--noise')
    print(f'largest bias of --noise: {worst:.2f} standard errors of one render')
    return 0 if worst < 1 / 3 else 1


if __name__ == '__main__':
    sys.exit(main())
