#!/usr/bin/python3
"""Renders the pictures of the course's write-ups: `lanewise replay [FILE...]`, which runs this.

    lanewise replay                                   all pictures and claims, to replay/index.html
    lanewise replay perf/replay/1_depth.json          this file's pictures alone
    lanewise replay --full                            with the write-ups' own numbers of samples
    lanewise replay --scenes FOLDER --out FOLDER      with the course's scenes in a folder; where to

What is rendered is said in small files, perf/replay/*.json (perf/replay_files.py tells their form). Each picture is
rendered once for a program and a scene and kept in a cache, so that a run which was stopped goes on where it was.
Scenes that are not there are replaced by shipped ones. Writes index.html, which needs no other file, every picture as a
PNG, contact-sheet.jpg and replay.json.
"""
import pathlib
import shlex
import sys

import command
import kept
from command import Problem, positive

command.need('matplotlib', 'numpy', 'PIL')

import lanewise  # noqa: E402
import replay_files  # noqa: E402

FOLDER = pathlib.Path(__file__).with_name('replay')


def parse_arguments(words):
    parser = command.parser_of('replay', __doc__)
    parser.add_argument('files', nargs='*', type=pathlib.Path, metavar='FILE',
                        help='what to render [all of perf/replay/*.json, and the claims]')
    parser.add_argument('--full', action='store_true', help='as many samples as the write-ups took')
    parser.add_argument('--samples', type=positive, metavar='N', help='a pixel, in place of the files\'')
    parser.add_argument('--no-claims', action='store_true', help='pictures alone')
    parser.add_argument('--scenes', type=pathlib.Path, default=lanewise.COURSE, metavar='FOLDER',
                        help='with the course\'s scenes, CBspheres.dae and others; shipped ones take their place')
    parser.add_argument('-r', '--resolution', type=positive, nargs=2, default=[480, 360], metavar=('W', 'H'),
                        help='[480 360]')
    parser.add_argument('--out', type=pathlib.Path, default=pathlib.Path('replay'), metavar='FOLDER', help='[replay]')
    parser.add_argument('--cache', type=pathlib.Path, default=kept.default_folder('replay'), metavar='FOLDER',
                        help='for what was rendered [%(default)s]')
    return parser.parse_args(words)


def command_line(words):
    """Without what says only where things lie."""
    hidden = ('--out', '--cache', '--scenes')
    return shlex.join(['lanewise', 'replay', *(w for before, w in zip(['', *words], words)
                                               if before not in hidden and not w.startswith(hidden))])


def main():
    args = parse_arguments(sys.argv[1:])
    if args.scenes != lanewise.COURSE and not args.scenes.is_dir():
        raise Problem(f'{args.scenes}: is no folder')
    place = replay_files.Place(args.scenes, args.resolution, args.full, args.samples)
    notes = []
    if not args.scenes.is_dir():
        notes.append('The course\'s scenes are not there (--scenes FOLDER); shipped ones stand in.')
    topics = [replay_files.read(path, place, notes) for path in args.files or sorted(FOLDER.glob('*.json'))]
    import replay_render  # here, for it and what follows take longer to load than all the checks above
    import replay_results
    try:
        (args.out / 'pictures').mkdir(parents=True, exist_ok=True)
        studio = replay_render.Studio(args.cache)
    except OSError as error:
        raise Problem(f'{error.filename}: {error.strerror}') from None
    rendered = replay_results.render_all(studio, topics)
    claims = [] if args.no_claims or args.files else replay_results.measure_claims(studio, place)
    replay_results.write(args.out, topics, rendered, claims, command_line(sys.argv[1:]), notes)
    print(f'{args.out / "index.html"}: {len(rendered)} pictures, {len(claims)} claims, {studio.rendered} renders')


if __name__ == '__main__':
    command.run(main)
