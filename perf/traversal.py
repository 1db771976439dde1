#!/usr/bin/python3
"""Rays alone against Embree's single-ray kernels: build/traversal_bench as table and chart.

    perf/traversal.py [--scenes FOLDER] [--rounds 5]

The same rays of each scene, one thread: Embree, our tree alone with every triangle in it, and the plan. The benchmark compares
the hits. It is built where Embree 3 is installed (tools/setup peers).
"""
import json
import pathlib
import subprocess
import sys
import tempfile

import lanewise
import study
from study import plt

PROGRAM = lanewise.BUILD / 'traversal_bench'
AIMS = {'CBspheres': ('plan', 8), 'CBbunny_microfacet_cu': ('plan', 3), 'CBdragon_microfacet_au': ('plan', 3)}
TREE_AIM = 1.2
TREE_SCENES = ['CBbunny_microfacet_cu', 'CBdragon_microfacet_au', 'builtin:dense:1000000']


def name_of(scene):
    return scene if scene.startswith('builtin:') else pathlib.Path(scene).stem


def bounce_factors(scene, kind):
    """How many times Embree's rays a second, of the bounces' rays."""
    return [s[f'{kind}_mrays'] / s['embree_mrays'] for s in scene['sets'] if s['rays'].startswith('bounce')]


def section(scenes):
    lines = ['Million rays a second and core, one thread, medians of runs in turn; in parentheses times Embree\'s. "Tree" has '
             'every triangle in our BVH; "plan" is what a render does.', '']
    body = []
    for scene in scenes:
        for s in scene['sets']:
            body.append([name_of(scene['scene']), s['rays'], f'{s["number"] / 1e3:.0f} k', f'{s["embree_mrays"]:.1f}']
                        + [f'{s[k + "_mrays"]:.1f} ({s[k + "_mrays"] / s["embree_mrays"]:.2f} x)' for k in ('tree', 'plan')])
    return lines + study.table(['scene', 'rays', 'number', 'Embree', 'tree', 'plan'], body)


def headlines(scenes):
    found = []
    for scene in scenes:
        name = name_of(scene['scene'])
        if name in TREE_SCENES:
            found.append((f'{name}, bounce rays: tree alone, times Embree\'s rays/s, least of the bounces',
                          f'{min(bounce_factors(scene, "tree")):.2f}', f'{TREE_AIM}'))
        if name in AIMS:
            kind, aim = AIMS[name]
            found.append((f'{name}, bounce rays: {kind}, times Embree\'s rays/s, least of the bounces',
                          f'{min(bounce_factors(scene, kind)):.1f}', f'{aim}'))
    return found


def draw(scenes, command):
    figure, axes = plt.subplots(1, len(scenes), figsize=(2.4 * len(scenes) + 0.8, 4.2), sharey=True, squeeze=False)
    for axis, scene in zip(axes[0], scenes):
        sets = scene['sets']
        for k, kind in enumerate(('tree', 'plan')):
            axis.plot(range(len(sets)), [s[f'{kind}_mrays'] / s['embree_mrays'] for s in sets], 'o-', markersize=5,
                      linewidth=0.8, color=study.COLOURS[k], label=kind)
        axis.axhline(1, color='black', linewidth=0.8)
        axis.axhline(TREE_AIM, color=study.COLOURS[0], linewidth=0.8, linestyle='--')
        if name_of(scene['scene']) in AIMS:
            axis.axhline(AIMS[name_of(scene['scene'])][1], color=study.COLOURS[1], linewidth=0.8, linestyle='--')
        axis.set_xticks(range(len(sets)), [s['rays'] for s in sets], rotation=60, fontsize=8)
        axis.set_title(name_of(scene['scene']), fontsize=9)
        axis.set_yscale('log')
    ticks = [0.5, 1, 2, 3, 5, 8, 15, 30]
    axes[0][0].set_yticks(ticks, [f'{t:g} x' for t in ticks])
    axes[0][0].minorticks_off()
    axes[0][0].set_ylabel('rays/s over Embree\'s')
    axes[0][0].legend(fontsize=8)
    figure.suptitle('Rays alone against Embree\'s single-ray kernels (dashed: aimed at)', fontsize=11)
    figure.tight_layout(rect=(0, 0.03, 1, 1))
    study.save_chart(figure, 'traversal', command)


def main():
    arguments = study.parser_of(__doc__).parse_args()
    if not PROGRAM.exists():
        print('traversal.py: skipped, build/traversal_bench is not there: it needs Embree 3')
        return 0
    scenes = [str(path) for path in study.scenes_of(arguments, lanewise.SHIPPED[:1])] + ['builtin:dense:1000000']
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / 'traversal.json'
        subprocess.run([PROGRAM, '--json', out, '--runs', str(arguments.rounds), *scenes], check=True)
        report = json.loads(out.read_text())
    for scene in report['scenes']:
        scene['scene'] = name_of(scene['scene'])
    draw(report['scenes'], study.command_line())
    study.publish('traversal', 'Rays against Embree', section(report['scenes']), headlines(report['scenes']), report)
    return 0


if __name__ == '__main__':
    sys.exit(main())
