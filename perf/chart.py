#!/usr/bin/python3
"""Charts error against seconds of rendering: `lanewise chart SCENE... [flags]`, which runs this.

    lanewise chart box.dae                                                    Lanewise alone
    lanewise chart box.dae --config 'mis:' --config 'chance: --direct bsdf'  two ways to sample, against each other
    lanewise chart box.dae --peers                                            and the other renderers that are installed
    lanewise chart box.dae --samples 1 2 4 8 16 --seeds 8 --out folder        where, and of how many renders

Every configuration renders at every number of samples with every seed, in turn; the error is against a reference of
many samples, whose own error is known from its two halves and taken off. Renders are kept in a cache, so that a run
that was cut short goes on where it was. Writes index.html, which needs no other file, with SCENE-mrse.svg (-flip.svg,
-samples.svg), chart.csv and chart.json beside it.
"""
import pathlib
import shlex
import sys
import time

import command
import kept
from command import Problem, positive

command.need('matplotlib', 'numpy')

import chart_renderers  # noqa: E402
import chart_store  # noqa: E402
import lanewise  # noqa: E402


def parse_arguments(words):
    parser = command.parser_of('chart', __doc__)
    parser.add_argument('scenes', nargs='+', metavar='SCENE', help='COLLADA file, or builtin:dense')
    parser.add_argument('--config', action='append', default=[], metavar="'NAME: FLAGS'",
                        help='a configuration: flags of lanewise render; may be repeated [Lanewise:]')
    parser.add_argument('--configs', type=pathlib.Path, metavar='FILE',
                        help='more of them, as JSON: {"NAME": "FLAGS", ...}')
    parser.add_argument('--peers', nargs='*', choices=chart_renderers.PEERS, metavar='NAME',
                        help=f'other renderers, all without a name: {", ".join(chart_renderers.PEERS)}')
    parser.add_argument('--peer-samples', type=positive, nargs='+', default=[4, 16, 64], metavar='N',
                        help='a pixel [4 16 64]')
    parser.add_argument('--samples', type=positive, nargs='+', default=[2**k for k in range(10)], metavar='N',
                        help='a pixel [1 2 4 ... 512]')
    parser.add_argument('--seeds', type=positive, default=4, metavar='K', help='independent renders of each [4]')
    parser.add_argument('--reference', type=positive, default=16384, metavar='N',
                        help='samples a pixel of the reference [16384]')
    parser.add_argument('--view', choices=['file', 'fit'], default='file', help='as of lanewise render [file]')
    parser.add_argument('-r', '--resolution', type=positive, nargs=2, default=[480, 360], metavar=('W', 'H'),
                        help='[480 360]')
    parser.add_argument('-m', '--max-depth', type=positive, default=5, metavar='N',
                        help='most scattering events on a path [5]')
    parser.add_argument('-t', '--threads', type=positive, default=2, metavar='N', help='[2]')
    parser.add_argument('--out', type=pathlib.Path, default=pathlib.Path('chart'), metavar='FOLDER', help='[chart]')
    parser.add_argument('--cache', type=pathlib.Path, default=kept.default_folder('chart'), metavar='FOLDER',
                        help='for what was measured [%(default)s]')
    parser.add_argument('--minutes', type=float, default=float('inf'), metavar='X',
                        help='begin no render after so long, draw what there is, and go on when run again')
    return parser.parse_args(words)


def command_line(words):
    """Without what says only where things lie, and when a part of the work ended."""
    kept, hidden = [], ('--out', '--cache', '--minutes')
    for before, word in zip(['', *words], words):
        if before not in hidden and not word.startswith(hidden):
            kept.append(pathlib.Path(word).name if pathlib.Path(word).is_file() else word)
    return shlex.join(['lanewise', 'chart', *kept])


def main():
    args = parse_arguments(sys.argv[1:])
    try:
        args.out.mkdir(parents=True, exist_ok=True)
        store = chart_store.Store(args.cache, time.monotonic() + 60 * args.minutes)
    except OSError as error:
        raise Problem(f'{error.filename}: {error.strerror}') from None
    subjects = [chart_renderers.Subject(scene, args.view, *args.resolution, args.max_depth, args.threads)
                for scene in args.scenes]
    names = [subject.name for subject in subjects]
    if len(set(names)) < len(names):
        raise Problem('two scenes have the same name, and so would their charts', 2)
    renderers = chart_renderers.configurations(args) + chart_renderers.peers(args)
    import chart_results  # here, for matplotlib takes longer than all the checks above
    line, notes, sections = command_line(sys.argv[1:]), [], []
    if not store.has_flip:
        notes.append('No FLIP: this lanewise compare has no --metric flip.')
    try:
        for subject in subjects:
            sections.append(chart_results.section_of(store, subject, args, renderers, line, notes))
    except kept.OutOfTime:
        pass
    if store.cut_short:
        notes.append('Not all is measured yet: the time was up. The same command goes on where this ended.')
    for note in notes:
        print(note)
    if not sections:
        raise Problem('out of time before there was anything to draw; the same command goes on where this ended')
    saved = {'command': line, 'machine': lanewise.machine(), 'notes': notes,
             'versions': {r.name: r.version for r in renderers}}
    chart_results.write(args.out, sections, store.rendered, saved)


if __name__ == '__main__':
    command.run(main)
