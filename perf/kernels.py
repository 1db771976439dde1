#!/usr/bin/python3
"""Time per path of every kernel beside its scalar twin, on every instruction set: build/kernels_bench as table and chart.

    perf/kernels.py [--rounds 5]

One thread, 4096 paths of a render of the test scene a call; rounds are interleaved at random, ratios taken within rounds. The
benchmark checks every result after timing and stops where one is wrong.
"""
import json
import pathlib
import subprocess
import sys
import tempfile

import lanewise
import study
from study import plt

AIMS = {'sse4': 3, 'avx2': 5, 'avx512': 8}  # times the twin
TRACING = ['intersect', 'occlude', 'occlude_connection', 'gather_emission']
WHY_LOW = {
    'sort': 'moves 20 fields of a path and computes nothing',
    'retire': 'three stores a path to where its slot says; no vector can help before AVX-512 has scatters',
    'accumulate': 'sums a pixel\'s samples in their order and in double, for the same bits everywhere; only the search for '
                  'invalid samples is in vectors',
    'emission': '12 fields from the second-level cache and two records, read lane by lane, for some 30 operations; the twin '
                'finds its path in the first-level cache',
    'surface': 'reads 11 fields and three records lane by lane, writes 10 fields, for some 40 operations',
    'count_shadow_rays': 'reads 12 bytes a path and counts',
}


def measure(rounds):
    """{kernel: {variant: [ns per path of each round]}}."""
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / 'kernels.json'
        subprocess.run([lanewise.BUILD / 'kernels_bench', f'--benchmark_repetitions={rounds}',
                        '--benchmark_enable_random_interleaving=true', '--benchmark_min_time=0.02',
                        f'--benchmark_out={out}', '--benchmark_out_format=json'], check=True, stdout=subprocess.DEVNULL)
        report = json.loads(out.read_text())
    paths = int(report['context']['paths'])
    rows = {}
    for run in sorted(report['benchmarks'], key=lambda run: run['family_index']):  # in the order of the data's flow
        if run['run_type'] == 'iteration':
            kernel, variant = run['run_name'].split('/')[:2]
            rounds_of = rows.setdefault(kernel, {}).setdefault(variant, {})
            rounds_of[run['repetition_index']] = run['real_time'] / paths  # time_unit is ns
    return {kernel: {v: [r[i] for i in sorted(r)] for v, r in variants.items()} for kernel, variants in rows.items()}


def section(rows, times, isas):
    best = isas[-1]
    lines = ['One thread; ns per path, medians; in parentheses the least of the rounds. "x" is the best instruction set '
             'against the twin on the same paths, median and range. Every result was checked after timing.', '']
    body = []
    for kernel, variants in rows.items():
        r = times[kernel][best]
        low = r['median'] < AIMS.get(best, 0) and kernel not in TRACING
        body.append([f'`{kernel}`'] + [f'{study.statistics.median(variants[v]):.2f} ({min(variants[v]):.2f})'
                                       for v in ['twin'] + isas]
                    + [f'{r["median"]:.1f} ({r["least"]:.1f} to {r["largest"]:.1f})', WHY_LOW.get(kernel, '') if low else ''])
    return lines + study.table(['kernel', 'twin'] + isas + [f'{best}, x', 'why it is low'], body)


def draw(times, isas, command):
    figure, axis = plt.subplots(figsize=(8, 1.5 + 0.3 * len(times)))
    for k, isa in enumerate(isas):
        found = [times[kernel][isa] for kernel in times]
        axis.errorbar([r['median'] for r in found], range(len(found)), xerr=study.error_bars(found), fmt='o', capsize=2,
                      markersize=5, color=study.COLOURS[k], label=isa)
        if isa in AIMS and isa == isas[-1]:
            axis.axvline(AIMS[isa], color=study.COLOURS[k], linewidth=1, linestyle='--', label=f'aimed at on {isa}')
    axis.axvline(1, color='black', linewidth=0.8)
    axis.set_xscale('log')
    ticks = [0.5, 1, 2, 3, 5, 8, 12, 20, 30]
    axis.set_xlim(0.3, 35)
    axis.set_xticks(ticks, [f'{t:g} x' for t in ticks])
    axis.minorticks_off()
    axis.set_yticks(range(len(times)), list(times))
    axis.invert_yaxis()
    axis.set_xlabel('ns per path of the scalar twin / of the kernel (median and range)')
    axis.set_title('Kernels against their scalar twins, one thread', fontsize=11)
    figure.legend(fontsize=8, loc='lower center', ncol=5, bbox_to_anchor=(0.5, 0.02))
    figure.tight_layout(rect=(0, 0.06, 1, 1))
    study.save_chart(figure, 'kernels', command)


def main():
    rounds = study.parser_of(__doc__).parse_args().rounds
    rows = measure(rounds)
    isas = [v for v in next(iter(rows.values())) if v not in ('twin', 'scalar')]
    times = {k: {isa: study.ratios(v['twin'], v[isa]) for isa in isas} for k, v in rows.items()}
    best = isas[-1]
    shading = [k for k in times if k not in TRACING + ['sort', 'retire', 'accumulate', 'count_shadow_rays']]
    good = [k for k in shading if times[k][best]['median'] >= AIMS.get(best, 0)]
    headline = [(f'kernels that compute shading at {AIMS.get(best, 0)} x their float twins on {best}',
                 f'{len(good)} of {len(shading)}; not '
                 + ', '.join(f'{k} {times[k][best]["median"]:.1f}' for k in shading if k not in good), 'all')]
    draw(times, isas, study.command_line())
    study.publish('kernels', 'Kernels against their scalar twins', section(rows, times, isas), headline,
                  {'ns_per_path': rows, 'times_faster': times})


if __name__ == '__main__':
    sys.exit(main())
