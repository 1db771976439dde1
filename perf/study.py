"""What the studies of speed share: scenes, runs in turn, charts, and the page perf/results/speed.md, which is made of what
each of them leaves in perf/results/<part>.json. A speed holds only beside others of the same run: so every round runs all
variants once, in turn, and ratios are taken within rounds."""
import argparse
import functools
import json
import pathlib
import statistics
import sys

import matplotlib

matplotlib.use('svg')
matplotlib.rcParams.update({'svg.hashsalt': 'lanewise', 'axes.spines.top': False, 'axes.spines.right': False,
                            'axes.grid': True, 'grid.alpha': 0.3, 'axes.axisbelow': True})
import matplotlib.pyplot as plt  # noqa: E402

import lanewise  # noqa: E402

sys.path.append(str(pathlib.Path(__file__).with_name('peers')))
import collada  # noqa: E402

PARTS = ['frames', 'traversal', 'kernels', 'wave_sweep', 'thread_scaling', 'size_study']  # in the page's order
COURSE = ['CBspheres', 'CBbunny_microfacet_cu', 'CBdragon_microfacet_au']
COLOURS = ['#1b6ca8', '#d95f02', '#2a9d5c', '#8e4ec6', '#b8860b', '#666666']


def parser_of(document):
    """With what all studies take: --scenes and --rounds."""
    parser = argparse.ArgumentParser(description=document.split('\n')[0])
    parser.add_argument('--scenes', nargs='+', type=pathlib.Path,
                        help='scene files, or a folder with the course scenes; default: those of the course that are '
                             'there, and of the shipped ones')
    parser.add_argument('--rounds', type=int, default=5)
    return parser


def scenes_of(arguments, shipped=None):
    """Paths, the course's first."""
    def in_folder(folder):
        return [folder / f'{name}.dae' for name in COURSE if (folder / f'{name}.dae').exists()]
    given = arguments.scenes
    if given is None:
        return in_folder(lanewise.COURSE) + (lanewise.SHIPPED if shipped is None else shipped)
    return [scene for path in given for scene in (in_folder(path) if path.is_dir() else [path.resolve()])]


def all_scenes_of(given):
    """Of files and folders; without any, all of the course's, or else the shipped ones."""
    if given is None:
        given = [lanewise.COURSE] if lanewise.COURSE.is_dir() else lanewise.SHIPPED
    return [scene for path in given for scene in (sorted(path.glob('*.dae')) if path.is_dir() else [path.resolve()])]


def view_flags(scene):
    """Those scenes that we ship have cameras of their own."""
    return ['--view', 'file' if scene in lanewise.SHIPPED else 'fit', '--normals', 'flat']


@functools.cache
def _camera(scene, size):
    return None if scene in lanewise.SHIPPED else collada.Scene(scene).camera('fit').framed(*size)


def render_whole(scene, size, *flags, estimate=False):
    """lanewise.render of size = (width, height) pixels; it shows what --view fit shows at 480 x 360, where that itself shows
    less the smaller the picture."""
    return lanewise.render(scene, '--normals', 'flat', '-r', *size, *flags, camera=_camera(scene, size), estimate=estimate)


def in_turn(measures, rounds):
    """measures: {name: function of the round's number}. {name: [its values]}."""
    values = {name: [] for name in measures}
    for index in range(rounds):
        for name, measure in measures.items():
            values[name].append(measure(index))
    return values


def ratios(slow, fast):
    """Of each round; median, least and largest."""
    each = sorted(a / b for a, b in zip(slow, fast))
    return {'median': statistics.median(each), 'least': each[0], 'largest': each[-1]}


def error_bars(found):
    """For matplotlib, of a list of ratios()."""
    return [[r['median'] - r['least'] for r in found], [r['largest'] - r['median'] for r in found]]


def command_line():
    here = pathlib.Path(sys.argv[0]).resolve()
    words = [str(here.relative_to(lanewise.ROOT))]
    # Where the scenes lie is of no interest to others.
    return ' '.join(words + [pathlib.Path(w).name if '/' in w else w for w in sys.argv[1:]])


def save_chart(figure, part, command):
    figure.text(0.995, 0.005, command, ha='right', fontsize=7, color='grey')
    figure.savefig(lanewise.RESULTS / f'{part}.svg', metadata={'Date': None})
    plt.close(figure)


def slope_guide(axis, x, y, power, label):
    """A line y ~ x^power through (x[0], y), on log axes."""
    axis.plot(x, [y * (v / x[0])**power for v in x], color='grey', linewidth=0.8, linestyle='--')
    axis.annotate(label, (x[-1], y * (x[-1] / x[0])**power), color='grey', fontsize=8, ha='right', va='top', textcoords='offset points',
                  xytext=(0, -6))


def table(head, rows):
    return ['| ' + ' | '.join(head) + ' |', '|' + '---|' * len(head)] + ['| ' + ' | '.join(r) + ' |' for r in rows]


def publish(part, title, lines, headlines, data, command=None):
    """lines: the part's section in Markdown, without its title. headlines: (what, figure, aim) for the table on top."""
    command = command or command_line()
    lanewise.RESULTS.mkdir(exist_ok=True)
    saved = {'title': title, 'command': command, 'lanewise': lanewise.version(), 'machine': lanewise.machine(),
             'headlines': headlines, 'section': lines, **data}
    (lanewise.RESULTS / f'{part}.json').write_text(json.dumps(saved, indent=1) + '\n')
    write_page()
    print('\n'.join(lines))


def write_page():
    found = {part: json.loads(path.read_text()) for part in PARTS
             if (path := lanewise.RESULTS / f'{part}.json').exists()}
    lines = ['# Speed', '',
             'Figures hold only beside each other: every one comes from runs in turn on one machine, named with its part. '
             '`perf/run_all.py` measures all parts again and writes this page, `perf/run_all.py --only PART` one of them.',
             '', '| figure | measured | aim |', '|---|---|---|']
    for saved in found.values():
        lines += ['| ' + ' | '.join(h) + ' |' for h in saved['headlines']]
    for part, saved in found.items():
        lines += ['', f'## {saved["title"]}', '', f'    {saved["command"]}', '',
                  f'{saved["machine"]}; Lanewise {saved["lanewise"]}.', '', f'![]({part}.svg)', '', *saved['section']]
    (lanewise.RESULTS / 'speed.md').write_text('\n'.join(lines) + '\n')
