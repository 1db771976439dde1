#!/usr/bin/python3
"""Speed against accuracy of the functions that kernels are made of, to perf/results/functions_speed.{json,svg,md}.

    tools/setup charts; tools/build lanewise functions_bench; perf/functions_chart.py

build/functions_bench measures: every variant (ours, Highway's, the scalar twins; Schlick's, the course's and the exact
Fresnel; two forms of Beckmann's D) on every instruction set of the machine.
"""
import argparse
import json
import math
import subprocess
import sys

from matplotlib.lines import Line2D

import lanewise
import study
from study import plt

SERIES = {'scalar': ('#666666', 'scalar'), 'sse4': ('#1b6ca8', 'SSE4'), 'avx2': ('#d95f02', 'AVX2'),
          'avx512': ('#2a9d5c', 'AVX-512'), 'float': ('#8e4ec6', 'twin, float'), 'double': ('#b8860b', 'twin, double')}
MARKERS = ['o', 's', '^']
COLUMNS = 4
OVERFLOW = 3e8  # where the chart shows errors without end, in ulp


def measure(rounds, stride):
    command = [lanewise.BUILD / 'functions_bench', '--rounds', rounds, '--stride', stride]
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


def largest(result):
    """JSON has no infinity."""
    return math.inf if result['max_ulp'] is None else result['max_ulp']


def pareto(results):
    """Those that no other beats in speed and in its largest error, from fast to slow."""
    front = []
    for r in sorted(results, key=lambda r: (r['cycles'], largest(r))):
        if not front or largest(r) < largest(front[-1]):
            front.append(r)
    return front


def draw_panel(axis, function):
    results = function['results']
    shapes = dict(zip(dict.fromkeys(r['variant'] for r in results), MARKERS))
    for r in results:
        colour, shape = SERIES[r['target']][0], shapes[r['variant']]
        top = min(largest(r), OVERFLOW)
        axis.plot(r['cycles'], top, shape, color=colour, markersize=6)
        if r['mean_ulp'] is None:
            axis.annotate('overflows  ', (r['cycles'], top), ha='right', va='center', fontsize=7, color=colour)
            continue
        axis.plot([r['cycles']] * 2, [r['mean_ulp'], top], color=colour, linewidth=0.8, alpha=0.5)
        axis.plot(r['cycles'], r['mean_ulp'], shape, color=colour, markersize=4, markerfacecolor='white')
    front = pareto(results)
    axis.step([r['cycles'] for r in front], [largest(r) for r in front], where='post', color='black', linewidth=0.8,
              linestyle=':', zorder=0)
    axis.set_title(function['name'], fontsize=10)
    axis.legend([Line2D([], [], color='black', marker=m, linestyle='', markersize=4) for m in shapes.values()], shapes,
                fontsize=7, loc='upper right', handletextpad=0.1, framealpha=0.7)


def draw(data, command):
    functions = data['functions']
    rows = -(-len(functions) // COLUMNS)
    figure, axes = plt.subplots(rows, COLUMNS, figsize=(12, 2.7 * rows + 0.9), sharex=True, sharey=True, squeeze=False)
    for axis, function in zip(axes.flat, functions):
        draw_panel(axis, function)
    axes[0][0].set_xscale('log')
    axes[0][0].set_yscale('log')
    axes[0][0].set_xlim(0.3, 1000)
    axes[0][0].set_ylim(0.01, 1e9)
    axes[0][0].set_yticks([10.0**k for k in range(-2, 10, 2)])
    for axis in axes.flat:
        axis.minorticks_off()
    for axis in axes[-1]:
        axis.set_xlabel('cycles per element', fontsize=9)
    for axis in axes[:, 0]:
        axis.set_ylabel('error (ulp)', fontsize=9)
    there = [s for s in SERIES if any(r['target'] == s for f in functions for r in f['results'])]
    handles = [Line2D([], [], color=SERIES[s][0], marker='o', linestyle='', label=SERIES[s][1]) for s in there]
    handles += [Line2D([], [], color='black', marker='o', linestyle='', label='largest error'),
                Line2D([], [], color='black', marker='o', markersize=4, markerfacecolor='white', linestyle='',
                       label='mean'),
                Line2D([], [], color='black', linestyle=':', linewidth=0.8, label='nothing is faster and closer')]
    figure.legend(handles=handles, fontsize=8, loc='lower center', ncol=len(handles), bbox_to_anchor=(0.5, 0.02))
    figure.suptitle('What an element costs, and how far off it is', fontsize=12)
    figure.tight_layout(rect=(0, 0.05, 1, 1))
    study.save_chart(figure, 'functions_speed', command)


class Results:
    """Results by name; on the best instruction set, if none is named."""

    def __init__(self, functions):
        self.functions = functions
        self.best = [r['target'] for r in functions[0]['results'] if r['variant'] == 'Lanewise'][-1]

    def get(self, function, variant, target=None):
        """function: how its name begins."""
        results = next(f['results'] for f in self.functions if f['name'].startswith(function))
        return next(r for r in results if (r['variant'], r['target']) == (variant, target or self.best))


def share(result):
    """The largest error as a share of the value, of which an ulp is 2^-24 to 2^-23."""
    return f'{result["max_ulp"] * 2**-24:.0%} to {result["max_ulp"] * 2**-23:.0%}'


def words(functions):
    found = Results(functions)

    def both(function, variant, target=None):
        r = found.get(function, variant, target)
        error = 'overflows' if r['max_ulp'] is None else f'{r["max_ulp"]:.2g} ulp'
        return f'{r["cycles"]:.3g} cycles, {error}'

    erfcx, product = found.get('exp(', 'Lanewise'), found.get('exp(', 'twin', 'float')
    gold, gold_schlick = found.get('Fresnel, gold', 'exact'), found.get('Fresnel, gold', 'Schlick')
    return [
        f'On {SERIES[found.best][1]}, unless it says otherwise:', '',
        f'- **Ours beside Highway\'s.** exp: {both("exp x", "Lanewise")} (Highway {both("exp x", "Highway")}). ln: '
        f'{both("ln", "Lanewise")} (Highway {both("ln", "Highway")}). Ours leave out what kernels never ask for: '
        'subnormal numbers, infinities, NaN.',
        f'- **Angles are best kept in turns.** Highway\'s sine is good (sin x: {both("sin x", "Highway")}), but '
        f'beside the zeros of sin 2πu the rounding of 2πu is all there is: {both("sin 2", "Highway")}. Reduced in '
        f'turns, which is exact, no digit is lost: {both("sin 2", "Lanewise")}, and the cosine comes with it. The '
        'float twins have Highway\'s error, the double ones do not.',
        '- **Vectors make speed, not fewer digits.** exp of the C library in double, rounded to float, is right to '
        f'half an ulp (one by one: {both("exp x", "twin", "double")}). Ours takes '
        f'{both("exp x", "Lanewise", "scalar")} in scalar code, and an element of a vector '
        f'{both("exp x", "Lanewise")}.',
        f'- **exp(x²) erfc x is a function of its own.** As a product in float: {both("exp(", "twin", "float")}. As '
        f'one polynomial: {both("exp(", "Lanewise")}, {product["cycles"] / erfcx["cycles"]:.0f} times faster.',
        f'- **Schlick\'s formula buys little.** Into glass: {both("Fresnel, into", "Schlick")}, '
        f'{share(found.get("Fresnel, into", "Schlick"))} of the value; the exact equations: '
        f'{both("Fresnel, into", "exact")}. The refracted cosine, which glass needs anyway, is most of the time of '
        f'both. On gold Schlick saves {gold["cycles"] - gold_schlick["cycles"]:.1f} cycles a channel, for an error of '
        f'{share(gold_schlick)}. The course\'s form for conductors: {both("Fresnel, gold", "course")}. Its form for '
        'glass takes the incident cosine on the way out too, and is then '
        f'{share(found.get("Fresnel, out", "course"))} off.',
        '- **Near total reflection digits are lost.** Out of glass, at a cosine 0.001 above it, the exact equations '
        f'in float are {found.get("Fresnel, out", "exact")["max_ulp"]:.0f} ulp off; one ulp of the cosine changes '
        'their value by 113.',
        '- **A stable form is free.** Beckmann\'s D from the parts of the half vector: '
        f'{both("Beckmann", "tan² of its parts")}; from its cosine: {both("Beckmann", "tan² of its cosine")}. What '
        'error is left comes from the exponent, -16 at a slope of four α, whose rounding exp multiplies by as much.',
    ]


def tables(functions):
    lines = []
    for function in functions:
        front = pareto(function['results'])
        rows = []
        for r in function['results']:
            cycles = f'{r["cycles"]:.2f}'
            rows.append([r['variant'], SERIES[r['target']][1], f'**{cycles}**' if r in front else cycles,
                         'overflows' if r['max_ulp'] is None else f'{r["max_ulp"]:.3g}',
                         '' if r['mean_ulp'] is None else f'{r["mean_ulp"]:.2g}', f'{r["worst_input"]:.9g}',
                         'yes' if r['zeros'] else 'no'])
        lines += ['', f'### {function["name"]}', '',
                  f'Input: {function["inputs"]}, {function["results"][0]["inputs"] / 1e6:.2g} million floats of '
                  f'[{function["lo"]:.6g}, {function["hi"]:.6g}].', '',
                  *study.table(['variant', 'on', 'cycles', 'max ulp', 'mean ulp', 'worst input', '0 at zeros'], rows)]
    return lines


def page(data):
    return '\n'.join([
        '# Speed against accuracy, function by function', '', f'    {data["command"]}', '',
        f'{data["machine"]}; Lanewise {data["lanewise"]}.', '', '![](functions_speed.svg)', '',
        'Left is faster, down is closer. The largest error against double precision is filled, the mean hollow, in '
        'ulp: '
        'spacings of floats at the exact value. No error is capped. Dotted: nothing is both faster and closer.', '',
        '## What it shows', '', *words(data['functions']), '', '## How it is measured', '',
        f'Arrays of {data["elements"]} floats in the first-level cache, {data["rounds"]} rounds of all variants in '
        'turn; the least counts. That is throughput, with a load and a store. Cycles are ticks of the time stamp '
        f'counter over those of a chain of multiplications of three cycles each ({data["ticks_per_cycle"]:.3f} ticks '
        'a cycle), so the clock does not '
        'matter. Indices and roughness are read anew for every vector, as in kernels.', '',
        f'Errors are those on every {data["stride"]}th float of the domain and on all floats around its ends and '
        'around what is hard in it; a mean over floats is mostly one over small ones. [functions.md](functions.md) '
        'has our elementary functions on all floats. Where the exact value is 0, all that counts is whether the '
        'result is. *Twin*: the scalar code of the '
        'reference path tracer, in float and in double, rounded at the end.', '', '## All figures', '',
        'Bold: nothing is both faster and closer.', *tables(data['functions']), ''])


def main():
    parser = argparse.ArgumentParser(description=__doc__.split('\n')[0])
    parser.add_argument('--rounds', type=int, default=300, help='of timing')
    parser.add_argument('--stride', type=int, default=257, help='errors on every N-th float')
    parser.add_argument('--redraw', action='store_true',
                        help='chart and page again from perf/results/functions_speed.json')
    arguments = parser.parse_args()
    saved = lanewise.RESULTS / 'functions_speed.json'
    if arguments.redraw:
        data = json.loads(saved.read_text())
    else:
        data = {'command': study.command_line(), 'lanewise': lanewise.version(), 'machine': lanewise.machine(),
                **measure(arguments.rounds, arguments.stride)}
        saved.write_text(json.dumps(data, indent=1, ensure_ascii=False) + '\n')
    draw(data, data['command'])
    (lanewise.RESULTS / 'functions_speed.md').write_text(page(data))
    print('\n'.join(words(data['functions'])))


if __name__ == '__main__':
    sys.exit(main())
