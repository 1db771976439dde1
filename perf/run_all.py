#!/usr/bin/python3
"""All studies of speed, one after the other, and the page perf/results/speed.md with their tables and charts.

    tools/setup charts; perf/peers/setup --all      # once: what they draw with and what they compare with
    perf/run_all.py                                 # some 20 minutes on two cores that have nothing else to do
    perf/run_all.py --only frames kernels           # these parts alone; the page keeps the others
    perf/run_all.py --page                          # nothing but the page again, from perf/results/*.json

Each part leaves perf/results/<part>.json and .svg when it is done, so that a run which is cut short goes on with
--only and the parts that are missing. A part that fails does not stop the others; the exit code is then 1.
"""
import argparse
import pathlib
import subprocess
import sys
import time

import lanewise
import study

SCRIPTS = {'frames': 'peers/frames.py'}  # others are named as their part


def main():
    parser = argparse.ArgumentParser(description=__doc__.split('\n')[0])
    parser.add_argument('--only', nargs='+', choices=study.PARTS, default=study.PARTS, metavar='PART',
                        help=', '.join(study.PARTS))
    parser.add_argument('--scenes', nargs='+', type=pathlib.Path, help='passed on')
    parser.add_argument('--page', action='store_true', help='only write the page again')
    arguments = parser.parse_args()
    if arguments.page:
        study.write_page()
        return 0
    failed = []
    for part in arguments.only:
        start = time.time()
        command = [lanewise.ROOT / 'perf' / SCRIPTS.get(part, f'{part}.py')]
        if arguments.scenes and part not in ('kernels', 'size_study'):
            command += ['--scenes', *arguments.scenes]
        print(f'-- {part}', flush=True)
        if subprocess.run([str(word) for word in command], check=False).returncode != 0:
            failed.append(part)
        print(f'-- {part}: {time.time() - start:.0f} s', flush=True)
    if failed:
        print('failed:', ', '.join(failed))
    return 1 if failed else 0


if __name__ == '__main__':
    sys.exit(main())
