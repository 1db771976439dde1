#!/usr/bin/python3
"""What rendering by several ranks of mpirun costs, and what it would on many machines.

    perf/ranks.py [--scene FILE] [--samples 256] [--rounds 5]

480 x 360 pixels, -m 5. Ranks of one thread each, on this machine's cores, beside one process with as many threads; where there are
more ranks than cores, beside one with all cores. In every round each runs once, in turn. Writes perf/results/ranks.{json,md}; needs
tools/setup charts mpi, and tools/build after that.
"""
import argparse
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile

import lanewise
import study

RANKS = [1, 2, 3, 4, 8]
BARE_SUMS = 80  # bytes of a pixel's sums, unpacked

# The farm of the model: nodes of 16 cores with one rank each, and 10 Gbit/s to rank 0.
CORES, BANDWIDTH = 16, 1.25e9
DESKS = CORES + 1 + CORES // 8  # as in core/remote_ranks.cc
WIDTH, HEIGHT = 7680, 4320


def render(scene, samples, ranks=None, threads=1, flags=()):
    """Statistics of a render, by that many ranks, or by one process without mpirun."""
    with tempfile.TemporaryDirectory() as folder:
        stats = pathlib.Path(folder) / 'stats.json'
        launch = ['mpirun', '--allow-run-as-root', '--oversubscribe', '-n', ranks] if ranks else []
        command = [*launch, lanewise.PROGRAM, 'render', scene, '-m', 5, '-s', samples, '-t', threads, '-q', '-f',
                   pathlib.Path(folder) / 'picture.pfm', '--stats', stats, *flags]
        done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise SystemExit(f'{" ".join(map(str, command))}: {done.stderr}')
        return json.loads(stats.read_text())


def measure(scene, samples, rounds):
    cores = os.cpu_count()
    beside = {ranks: min(ranks, cores) for ranks in RANKS}
    variants = {('threads', threads): lambda _, threads=threads: render(scene, samples, threads=threads)
                for threads in sorted(set(beside.values()))}
    variants |= {('ranks', ranks): lambda _, ranks=ranks: render(scene, samples, ranks) for ranks in RANKS}
    found = study.in_turn({key: lambda i, run=run: run(i) for key, run in variants.items()}, rounds)
    rows = []
    for ranks in RANKS:
        runs, alone = found['ranks', ranks], found['threads', beside[ranks]]
        ratios = [r['seconds']['render'] / a['seconds']['render'] for r, a in zip(runs, alone)]
        rows.append({'ranks': ranks, 'cores': beside[ranks],
                     'seconds': statistics.median(r['seconds']['render'] for r in runs),
                     'ratio': statistics.median(ratios), 'least': min(ratios), 'largest': max(ratios),
                     'sent': [r['bytes_sent'] for r in runs[-1].get('ranks', [])[1:]],
                     'received': [r['bytes_received'] for r in runs[-1].get('ranks', [])[1:]]})
    return rows


def bytes_a_pixel(scene):
    """That the other rank sends for a pixel and a round, at numbers of samples of a round; what it sends once is taken off by
    rendering pictures of two sizes."""
    sizes = {}
    for samples in (1, 16, 256, 1024):
        sent, pixels = [], []
        for crop in ((0, 0, 120, 360), (0, 0, 480, 360)):
            other = render(scene, samples, 2, flags=('--no-estimate', '-p', *crop))['ranks'][1]
            sent.append(other['bytes_sent'])
            pixels.append(other['samples'] / samples)
        sizes[samples] = (sent[1] - sent[0]) / (pixels[1] - pixels[0])
    return sizes


def model(rate, sums_a_second, size):
    """Seconds that an 8K picture takes: all ranks drawing, rank 0's network, rank 0's adding; for samples in one round."""
    pixels = WIDTH * HEIGHT
    rows = []
    for samples in (64, 1024, 4096):
        for ranks in (10, 100, 1000):
            draw = pixels * samples / (rate * CORES * ranks)
            network = pixels * size / BANDWIDTH
            add = pixels / (sums_a_second * CORES)
            rows.append((samples, ranks, draw, network, add))
    return rows


def sums_a_second():
    """Pixels that one thread unpacks and adds, by the benchmark."""
    said = subprocess.run([lanewise.BUILD / 'packed_sums_bench', '--benchmark_format=json', '--benchmark_filter=Unpack'],
                          capture_output=True, text=True, check=True).stdout
    return json.loads(said)['benchmarks'][0]['items_per_second']


def main():
    parser = argparse.ArgumentParser(description=__doc__.split('\n')[0])
    parser.add_argument('--scene', type=pathlib.Path, default=lanewise.ROOT / 'scenes' / 'cornell_spheres.dae')
    parser.add_argument('--samples', type=int, default=256, help='a pixel')
    parser.add_argument('--rounds', type=int, default=5)
    arguments = parser.parse_args()
    rows = measure(arguments.scene, arguments.samples, arguments.rounds)
    sizes = bytes_a_pixel(arguments.scene)
    alone = render(arguments.scene, arguments.samples)
    rate = alone['samples'] / alone['seconds']['render']
    adds = sums_a_second()
    size = max(sizes.values())

    lines = ['# Ranks', '', f'    {study.command_line()}', '', f'{lanewise.machine()}; Lanewise {lanewise.version()}.', '',
             f'{arguments.scene.stem}, 480 x 360 pixels, {arguments.samples} samples, -m 5, ranks of one thread; beside one process with '
             'as many threads, at most as many as there are cores. Time, and bytes that a rank sent and received (mean over those that '
             'did). Ratios are of runs in the same round: median and range.', '']
    lines += study.table(
        ['ranks', 'cores', 'seconds', 'time / one process', 'efficiency', 'sent, MB', 'received, MB'],
        [[str(r['ranks']), str(r['cores']), f"{r['seconds']:.2f}", f"{r['ratio']:.3f} ({r['least']:.3f} to {r['largest']:.3f})",
          f"{100 / r['ratio']:.0f}%", f"{statistics.mean(r['sent'] or [0]) / 1e6:.2f}",
          f"{statistics.mean(r['received'] or [0]) / 1e6:.3f}"] for r in rows])
    lines += ['', f"A pixel's sums are {BARE_SUMS} bytes, and what is sent of them, for each pixel and round:", '']
    lines += study.table(['samples in the round', 'bytes'], [[str(n), f'{b:.1f}'] for n, b in sizes.items()])
    lines += ['', '## On 1,000 machines', '',
              f'A model, for a picture of {WIDTH} x {HEIGHT} drawn in one round (-s up to 4096, --no-estimate), of nodes of {CORES} cores '
              f'that draw {rate * 1e-6:.2f} M samples/s each, as one here. All film goes to rank 0: {size:.0f} bytes a pixel, over '
              f'{BANDWIDTH * 8e-9:.0f} Gbit/s; its {CORES} cores add {adds * 1e-6:.0f} M pixels/s each, if they do nothing else.', '']
    lines += study.table(['samples', 'ranks', 'drawing, s', "rank 0's network, s", "rank 0's adding, s"],
                         [[str(s), str(n), f'{d:.1f}', f'{w:.2f}', f'{a:.2f}'] for s, n, d, w, a in model(rate, adds, size)])
    limit = WIDTH * HEIGHT * size / BANDWIDTH
    enough = limit * rate * CORES * 1000 / (WIDTH * HEIGHT)
    lines += ['', f'What arrives does not hang on how many send it, so rank 0 needs {limit:.1f} s for the film whatever the ranks, and '
              f'1,000 of them are of use only from {enough:.0f} samples a round on. For less, and for the error estimate, whose rounds '
              'double from 64 samples on and send the film each time, the film\'s reduction is the limit. Three things keep it away: '
              'sums are packed; every tile is drawn whole, so that a round sends each pixel once; and, as merging is exact in any '
              'grouping, ranks can be split: of 1,000, 31 renders of 32 ranks each draw a range of the samples (`--samples`), each '
              'with a rank 0 of its own, and `lanewise merge` adds the 31 film files, some at a time on different machines. That is '
              f'the way from some 100 ranks on, also because rank 0 keeps a waiting thread for each draw that it has asked for: {DESKS} '
              f'a rank of {CORES} threads.', '']
    (lanewise.RESULTS / 'ranks.md').write_text('\n'.join(lines))
    (lanewise.RESULTS / 'ranks.json').write_text(json.dumps(
        {'scene': arguments.scene.stem, 'samples': arguments.samples, 'ranks': rows, 'bytes_a_pixel': sizes,
         'samples_a_second': rate, 'sums_a_second': adds}, indent=1) + '\n')
    print('\n'.join(lines))
    two = next(r for r in rows if r['ranks'] == 2)
    return 0 if two['ratio'] <= 1.1 else 1


if __name__ == '__main__':
    sys.exit(main())
